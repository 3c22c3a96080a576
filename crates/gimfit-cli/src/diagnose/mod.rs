//! `gimfit diagnose`: how a fit would go, told before any run.

mod advice;
mod arguments;
pub(crate) mod grid;
mod json;
mod print;

pub(crate) use arguments::{DiagnoseArguments, DiagnoseGridArguments};

use crate::basis::described;
use crate::curve::{Shape, explain_fit, shape};
use crate::explain::explain;
use crate::{Ending, output};
use gimfit::{
    BlendingOptions, CurveDiagnosis, CurveOptions, PointsView, diagnose_blending_curve,
    diagnose_curve,
};
use gimfit_io::points::PointTable;

/// A diagnosis with the file it is of.
struct Case<'a> {
    table: &'a PointTable,
    diagnosis: &'a CurveDiagnosis,
    /// Name of a basis that is no B-spline.
    basis: Option<String>,
}

impl Case<'_> {
    /// A point fitted, in the words of the file.
    fn place(&self, point: usize) -> String {
        let row = self.diagnosis.kept_points.as_ref().map_or(point, |kept| kept[point]);
        self.table.row_name(row)
    }

    /// The step of the parameters that begins at a point fitted.
    fn step(&self, point: usize) -> String {
        let next = (point + 1) % self.diagnosis.matrix.points;
        format!("from {} to {}", self.place(point), self.place(next))
    }
}

pub(crate) fn run(arguments: &DiagnoseArguments) -> anyhow::Result<Ending> {
    let Shape { table, options, basis } = shape(&arguments.input, &arguments.shape)?;
    let options = CurveOptions { residual: arguments.target.tolerance, ..options };
    let view = PointsView::new(table.dimension(), &table.coordinates)
        .map_err(|error| explain(error, &table))?;
    let result = match &basis {
        None => diagnose_curve(view, &options),
        Some(basis) => {
            let options = BlendingOptions {
                parameterization: options.parameterization,
                residual: options.residual,
                ..BlendingOptions::default()
            };
            diagnose_blending_curve(view, &**basis, &options)
        }
    };
    let diagnosis =
        result.map_err(|error| explain_fit(error, &table, &arguments.input, &arguments.shape))?;
    let case =
        Case { table: &table, diagnosis: &diagnosis, basis: basis.as_deref().map(described) };
    if arguments.json {
        output::data(&json::text(&case)?)?;
    } else {
        output::text(&print::report(&case))?;
    }
    Ok(Ending::Done)
}
