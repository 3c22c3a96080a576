//! A surface in all the forms it can be written in.

use super::{Job, draw};
use crate::outputs::Product;
use gimfit_io::document::SurfaceDocument;
use gimfit_io::table::write_rows;
use std::io::{self, Write};

impl Product for Job<'_> {
    fn svg(&self) -> String {
        draw::figure(self)
    }

    /// Control points after their row and column, or samples after their parameters.
    fn table(&self, out: &mut dyn Write) -> io::Result<String> {
        let (surface, names) = (&self.fit.surface, &self.grid.column_names);
        let net = surface.control_net();
        let Some((rows, columns)) = self.samples else {
            let [rows, columns] = net.shape();
            let labels = (0..rows * columns)
                .map(|place| [(place / columns).to_string(), (place % columns).to_string()]);
            write_rows(out, ["row", "column"], names, labels, net.points().iter())?;
            return Ok(format!("{rows} x {columns} control points"));
        };
        let steps = [surface.knots()[0].equal_steps(rows), surface.knots()[1].equal_steps(columns)];
        let points = draw::sample(surface, &steps);
        let labels = steps[0]
            .iter()
            .flat_map(|u| steps[1].iter().map(move |v| [format!("{u:?}"), format!("{v:?}")]));
        write_rows(out, ["u", "v"], names, labels, points.chunks_exact(surface.dimension()))?;
        Ok(format!("{rows} x {columns} samples"))
    }

    fn json(&self, geometry: bool) -> anyhow::Result<String> {
        let mut document = self.document.clone();
        if !geometry {
            document = SurfaceDocument {
                geometry: None,
                parameters: None,
                foot_parameters: None,
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
            let bases = self.bases.clone();
            visit(iteration, &mut Job::new(self.grid, &fit, bases, self.samples, self.seconds))?;
        }
        Ok(())
    }
}
