//! Files of a fit, by their endings: all produced first, then named.

use crate::arguments::WritingArguments;
use crate::family::{self, Family, Keep};
use crate::input;
use crate::targets::{self, Kind, is_standard, kind, known_kind};
use anyhow::{Context, ensure};
use gimfit_io::write::{Prepared, prepare_file};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What can be written, and the endings that ask for it.
const ENDINGS: [(Kind, &str); 4] =
    [(Kind::Json, ".json"), (Kind::Csv, ".csv"), (Kind::Svg, ".svg"), (Kind::Png, ".png")];

/// Pixels per unit of a picture: sharp on screens of high resolution.
const PNG_SCALE: f32 = 2.0;

/// Where a command is to write.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wanted<'a> {
    pub(crate) arguments: &'a WritingArguments,
    /// Fits that are kept, for files of each.
    keep: Keep<'a>,
    /// Whether samples were asked for.
    samples: bool,
}

impl<'a> Wanted<'a> {
    pub(crate) fn new(arguments: &'a WritingArguments, keep: &'a [usize], samples: bool) -> Self {
        Self { arguments, keep: Keep::Iterations(keep), samples }
    }

    /// With files of every fit that is found.
    pub(crate) fn of_all(arguments: &'a WritingArguments) -> Self {
        Self { arguments, keep: Keep::Sizes, samples: false }
    }

    /// File of the report.
    pub(crate) fn report(&self) -> Option<&'a Path> {
        self.arguments.report.as_deref()
    }

    /// Refuses outputs that cannot work, before any work is done; `inputs` are the files to read,
    /// by the argument that names them.
    pub(crate) fn check(&self, inputs: &[(&str, &Path)]) -> anyhow::Result<()> {
        for path in &self.arguments.output {
            known_kind(path, &ENDINGS)?;
        }
        let mut files: Vec<PathBuf> = Vec::new();
        for path in &self.arguments.output {
            files.extend(family::files(path, self.keep)?);
        }
        ensure!(
            !self.report().is_some_and(family::has_place),
            "--report writes one report, that of the whole run; the documents of \
             -o FILE-{{k}}.json hold the reports of the kept fits"
        );
        let outputs: Vec<&Path> = files.iter().map(PathBuf::as_path).chain(self.report()).collect();
        let standard = outputs.iter().filter(|path| is_standard(path)).count();
        ensure!(
            standard + usize::from(self.arguments.json) <= 1,
            "--json, -o - and --report - each write to standard output; use one of them, once"
        );
        ensure!(
            !self.samples || self.arguments.output.iter().any(|path| kind(path) == Some(Kind::Csv)),
            "--samples belongs to an output that ends in .csv"
        );
        input::check_standard_input(inputs)?;
        let inputs: Vec<&Path> = inputs.iter().map(|(_, path)| *path).collect();
        targets::check(&outputs, &inputs)
    }
}

/// A fit that can be written in all forms.
pub(crate) trait Product {
    /// The picture.
    fn svg(&self) -> String;

    /// The table, and what it holds.
    fn table(&self, out: &mut dyn Write) -> io::Result<String>;

    /// The document on one line, with or without what can be long.
    fn json(&self, geometry: bool) -> anyhow::Result<String>;

    /// Writes the whole document.
    fn write_json(&self, out: &mut dyn Write) -> io::Result<()>;

    /// Notes how long writing took, in seconds.
    fn set_write_time(&mut self, seconds: f64);

    /// Calls `visit` with each kept fit as a product of its own.
    fn each_member(
        &self,
        visit: &mut dyn FnMut(usize, &mut dyn Product) -> anyhow::Result<()>,
    ) -> anyhow::Result<()>;
}

/// All that is to be written, complete: files that have not yet taken their names, and the document
/// for standard output.
#[derive(Default)]
pub(crate) struct Outputs {
    files: Vec<Prepared>,
    document: Option<String>,
    /// What the files are, a line each.
    pub(crate) written: Vec<String>,
}

impl Outputs {
    /// Produces everything but the report: the files of each kept fit, then those of the whole run.
    pub(crate) fn prepare(product: &mut dyn Product, wanted: Wanted<'_>) -> anyhow::Result<Self> {
        let clock = Instant::now();
        let mut outputs = Self::default();
        let families: Vec<Family<'_>> =
            wanted.arguments.output.iter().filter_map(|path| Family::of(path)).collect();
        if !families.is_empty() {
            let mut members = Vec::new();
            product.each_member(&mut |iteration, member| {
                members.push(iteration);
                let paths: Vec<PathBuf> = families.iter().map(|f| f.file(iteration)).collect();
                outputs.produce(member, &paths, clock)
            })?;
            outputs.written =
                families.iter().map(|family| family.wrote(wanted.keep, &members)).collect();
        }
        let single: Vec<PathBuf> = wanted
            .arguments
            .output
            .iter()
            .filter(|path| Family::of(path).is_none())
            .cloned()
            .collect();
        outputs.produce(product, &single, clock)?;
        product.set_write_time(clock.elapsed().as_secs_f64());
        let report = wanted.report().filter(|path| !is_standard(path));
        outputs.written.extend(report.map(|path| format!("{}: report", path.display())));
        Ok(outputs)
    }

    /// Produces files of one fit. Documents come last, so that they can tell how long the others
    /// took.
    fn produce(
        &mut self,
        product: &mut dyn Product,
        paths: &[PathBuf],
        clock: Instant,
    ) -> anyhow::Result<()> {
        let mut picture = None;
        for path in paths {
            match kind(path) {
                Some(Kind::Csv) => {
                    let mut what = String::new();
                    self.files.push(prepare_file(path, |out| {
                        what = product.table(out)?;
                        Ok(())
                    })?);
                    self.written.push(format!("{}: {what}", path.display()));
                }
                Some(Kind::Svg) => {
                    let svg = picture.get_or_insert_with(|| product.svg());
                    self.file(path, "picture", |out| out.write_all(svg.as_bytes()))?;
                }
                Some(Kind::Png) => {
                    let svg = picture.get_or_insert_with(|| product.svg());
                    let png = gimfit_io::figure::svg_to_png(svg, PNG_SCALE)
                        .with_context(|| format!("cannot write {}", path.display()))?;
                    self.file(path, "picture", |out| out.write_all(&png))?;
                }
                Some(Kind::Json | Kind::StandardOutput) | None => {}
            }
        }
        product.set_write_time(clock.elapsed().as_secs_f64());
        for path in paths {
            match kind(path) {
                Some(Kind::StandardOutput) => self.document = Some(product.json(true)?),
                Some(Kind::Json) => {
                    self.file(path, "document", |out| product.write_json(out))?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Produces the report where a file was asked for.
    pub(crate) fn report(
        &mut self,
        product: &dyn Product,
        wanted: Wanted<'_>,
        text: &str,
    ) -> anyhow::Result<()> {
        let Some(path) = wanted.report().filter(|path| !is_standard(path)) else {
            return Ok(());
        };
        let json = (kind(path) == Some(Kind::Json)).then(|| product.json(false)).transpose()?;
        let content = json.as_deref().unwrap_or(text);
        self.files.push(prepare_file(path, |out| out.write_all(content.as_bytes()))?);
        Ok(())
    }

    /// Lets all files take their names, now that none can fail to be produced; gives back what
    /// standard output is to hold.
    pub(crate) fn keep(self) -> anyhow::Result<Option<String>> {
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
}
