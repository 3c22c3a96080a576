//! A curve in all the forms it can be written in.

use super::{Job, draw};
use crate::outputs::Product;
use gimfit_io::document::Document;
use gimfit_io::table::{write_control_points, write_samples};
use std::io::{self, Write};

impl Product for Job<'_> {
    fn svg(&self) -> String {
        draw::figure(self)
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<String> {
        let (curve, names) = (&self.fit.curve, &self.table.column_names);
        match self.samples {
            None => {
                write_control_points(out, curve, names)?;
                Ok(format!("{} control points", curve.control_points().len()))
            }
            Some(samples) => {
                write_samples(out, curve, &curve.equal_steps(samples), 0, names)?;
                Ok(format!("{samples} samples"))
            }
        }
    }

    fn json(&self, geometry: bool) -> anyhow::Result<String> {
        let mut document = Document { report: self.document.report.clone(), ..Document::default() };
        if geometry {
            document = self.document.clone();
        }
        Ok(serde_json::to_string(&document)? + "\n")
    }

    fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        serde_json::to_writer(&mut *out, &self.document)?;
        out.write_all(b"\n")
    }

    fn set_write_time(&mut self, seconds: f64) {
        if let Some(times) = self.document.report.as_mut().and_then(|r| r.run.seconds.as_mut()) {
            times.write = Some(seconds);
        }
    }

    fn each_member(
        &self,
        visit: &mut dyn FnMut(usize, &mut dyn Product) -> anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        for kept in &self.fit.sequence {
            let iteration = kept.entry.iteration;
            let fit = self.fit.member(iteration)?;
            let basis = self.basis.clone();
            visit(iteration, &mut Job::new(self.table, &fit, basis, self.samples, self.seconds))?;
        }
        Ok(())
    }
}
