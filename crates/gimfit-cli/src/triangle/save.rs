//! A triangular patch in all the forms it can be written in.

use super::samples::{Sample, samples, write_samples};
use super::{Job, draw, row_and_column};
use crate::outputs::Product;
use gimfit_io::document::TriangleDocument;
use gimfit_io::table::write_rows;
use std::io::{self, Write};

impl Product for Job<'_> {
    fn svg(&self) -> String {
        draw::figure(self)
    }

    /// Control points after their row and column, or samples after their parameters.
    fn table(&self, out: &mut dyn Write) -> io::Result<String> {
        let (patch, names) = (&self.fit.patch, &self.table.column_names);
        if let Some(count) = self.samples {
            let samples: Vec<Sample> = samples(count).collect();
            write_samples(out, patch, &samples, names)?;
            return Ok(format!("{} samples", samples.len()));
        }
        let points = patch.control_points();
        let labels = (0..points.len()).map(|index| {
            let (row, column) = row_and_column(index);
            [row.to_string(), column.to_string()]
        });
        write_rows(out, ["row", "column"], names, labels, points.iter())?;
        Ok(format!("{} control points", points.len()))
    }

    fn json(&self, geometry: bool) -> anyhow::Result<String> {
        let mut document = self.document.clone();
        if !geometry {
            document = TriangleDocument {
                geometry: None,
                coordinate_names: None,
                sequence: None,
                ..document
            };
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
            visit(iteration, &mut Job::new(self.table, &fit, self.samples, self.seconds))?;
        }
        Ok(())
    }
}
