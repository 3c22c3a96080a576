//! Files of a fit, by their endings.

use super::{Job, draw, plan};
use crate::arguments::CurveArguments;
use crate::input;
use crate::targets::{self, Kind, is_standard, kind, known_kind};
use anyhow::{Context, ensure};
use gimfit_io::document::Document;
use gimfit_io::table::{write_control_points, write_samples};
use gimfit_io::write::{Prepared, prepare_file};
use std::io::{self, Write};
use std::path::Path;
use std::time::Instant;

/// What can be written, and the endings that ask for it.
const ENDINGS: [(Kind, &str); 4] =
    [(Kind::Json, ".json"), (Kind::Csv, ".csv"), (Kind::Svg, ".svg"), (Kind::Png, ".png")];

/// Refuses outputs that cannot work, before any work is done.
pub(super) fn check(arguments: &CurveArguments) -> anyhow::Result<()> {
    for path in &arguments.output {
        known_kind(path, &ENDINGS)?;
    }
    let outputs: Vec<&Path> =
        arguments.output.iter().chain(&arguments.report).map(|path| path.as_path()).collect();
    let standard = outputs.iter().filter(|path| is_standard(path)).count();
    ensure!(
        standard + usize::from(arguments.json) <= 1,
        "--json, -o - and --report - each write to standard output; use one of them, once"
    );
    ensure!(
        arguments.samples.is_none()
            || arguments.output.iter().any(|path| kind(path) == Some(Kind::Csv)),
        "--samples belongs to an output that ends in .csv"
    );
    ensure!(arguments.samples.is_none_or(|n| n >= 2), "--samples must be at least 2");
    let inputs = plan::inputs(arguments);
    input::check_standard_input(&inputs)?;
    let inputs: Vec<&Path> = inputs.iter().map(|(_, path)| *path).collect();
    targets::check(&outputs, &inputs)
}

/// All that is to be written, complete: files that have not yet taken their names, and the document
/// for standard output.
#[derive(Default)]
pub(super) struct Outputs {
    files: Vec<Prepared>,
    document: Option<String>,
    /// What the files are, a line each.
    pub(super) written: Vec<String>,
}

impl Outputs {
    /// Produces everything but the report. Documents come last, so that they can tell how long the
    /// others took.
    pub(super) fn prepare(job: &mut Job<'_>, arguments: &CurveArguments) -> anyhow::Result<Self> {
        let clock = Instant::now();
        let mut outputs = Self::default();
        let mut picture = None;
        for path in &arguments.output {
            match kind(path) {
                Some(Kind::Csv) => outputs.table(job, arguments, path)?,
                Some(Kind::Svg) => {
                    let svg = picture.get_or_insert_with(|| draw::figure(job));
                    outputs.file(path, "picture", |out| out.write_all(svg.as_bytes()))?;
                }
                Some(Kind::Png) => {
                    let svg = picture.get_or_insert_with(|| draw::figure(job));
                    let png = gimfit_io::figure::svg_to_png(svg, PNG_SCALE)
                        .with_context(|| format!("cannot write {}", path.display()))?;
                    outputs.file(path, "picture", |out| out.write_all(&png))?;
                }
                Some(Kind::Json | Kind::StandardOutput) | None => {}
            }
        }
        set_write_time(job, clock);
        for path in &arguments.output {
            match kind(path) {
                Some(Kind::StandardOutput) => outputs.document = Some(json_text(job, true)?),
                Some(Kind::Json) => {
                    outputs.file(path, "document", |out| write_json(&job.document, out))?;
                }
                _ => {}
            }
        }
        set_write_time(job, clock);
        let report = arguments.report.iter().filter(|path| !is_standard(path));
        outputs.written.extend(report.map(|path| format!("{}: report", path.display())));
        Ok(outputs)
    }

    /// Produces the report where a file was asked for.
    pub(super) fn report(
        &mut self,
        job: &Job<'_>,
        arguments: &CurveArguments,
        text: &str,
    ) -> anyhow::Result<()> {
        let Some(path) = arguments.report.as_ref().filter(|path| !is_standard(path)) else {
            return Ok(());
        };
        let json = (kind(path) == Some(Kind::Json)).then(|| json_text(job, false)).transpose()?;
        let content = json.as_deref().unwrap_or(text);
        self.files.push(prepare_file(path, |out| out.write_all(content.as_bytes()))?);
        Ok(())
    }

    /// Lets all files take their names, now that none can fail to be produced; gives back what
    /// standard output is to hold.
    pub(super) fn keep(self) -> anyhow::Result<Option<String>> {
        for file in self.files {
            file.keep()?;
        }
        Ok(self.document)
    }

    fn file(
        &mut self,
        path: &Path,
        what: &str,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> anyhow::Result<()> {
        self.files.push(prepare_file(path, content)?);
        self.written.push(format!("{}: {what}", path.display()));
        Ok(())
    }

    fn table(
        &mut self,
        job: &Job<'_>,
        arguments: &CurveArguments,
        path: &Path,
    ) -> anyhow::Result<()> {
        let (curve, names) = (&job.fit.curve, &job.table.column_names);
        match arguments.samples {
            None => {
                let what = format!("{} control points", curve.control_points().len());
                self.file(path, &what, |out| write_control_points(out, curve, names))
            }
            Some(samples) => {
                let parameters = curve.equal_steps(samples);
                self.file(path, &format!("{samples} samples"), |out| {
                    write_samples(out, curve, &parameters, 0, names)
                })
            }
        }
    }
}

/// Pixels per unit of a picture: sharp on screens of high resolution.
const PNG_SCALE: f32 = 2.0;

fn set_write_time(job: &mut Job<'_>, clock: Instant) {
    if let Some(seconds) = job.document.report.as_mut().and_then(|r| r.seconds.as_mut()) {
        seconds.write = Some(clock.elapsed().as_secs_f64());
    }
}

/// The document on one line, with or without what can be long.
pub(super) fn json_text(job: &Job<'_>, geometry: bool) -> anyhow::Result<String> {
    let mut document = Document { report: job.document.report.clone(), ..Document::default() };
    if geometry {
        document = job.document.clone();
    }
    Ok(serde_json::to_string(&document)? + "\n")
}

fn write_json(document: &Document, out: &mut dyn Write) -> io::Result<()> {
    serde_json::to_writer(&mut *out, document)?;
    out.write_all(b"\n")
}
