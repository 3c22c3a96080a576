//! The fits found, in all the forms they can be written in.

use crate::outputs::Product;
use gimfit::{ApproximationReport, CurveFit, SurfaceFit};
use gimfit_io::document::Seconds;
use gimfit_io::figure::{ChoicesFigure, choices_figure_svg};
use serde_json::{Value, json};
use std::io::{self, Write};

/// A fit as it stands in the list.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Choice {
    /// The distance that it was to keep within.
    pub(super) distance: f64,
    pub(super) met: bool,
    /// A closed curve's repeated ones not counted.
    pub(super) control_points: usize,
    /// Rows and columns of a net.
    pub(super) net: Option<[usize; 2]>,
    pub(super) largest: f64,
    pub(super) rms: f64,
    pub(super) mean: f64,
    pub(super) overshoot: f64,
    pub(super) calm: bool,
    pub(super) corners: usize,
}

impl Choice {
    pub(super) fn of_curve(fit: &CurveFit) -> Self {
        let account = fit.report.approximation.as_ref();
        let target = fit.report.run.residual_target;
        Self::new(fit.curve.free_control_points(), None, target, account)
    }

    pub(super) fn of_surface(fit: &SurfaceFit) -> Self {
        let net = fit.surface.control_net();
        let account = fit.report.approximation.as_ref();
        Self::new(net.points().len(), Some(net.shape()), fit.report.run.residual_target, account)
    }

    fn new(
        control_points: usize,
        net: Option<[usize; 2]>,
        distance: f64,
        account: Option<&ApproximationReport>,
    ) -> Self {
        let of = |figure: fn(&ApproximationReport) -> f64| account.map_or(f64::NAN, figure);
        Self {
            distance,
            met: account.is_some_and(|account| account.met),
            control_points,
            net,
            largest: of(|account| account.max_distance),
            rms: of(|account| account.rms_distance),
            mean: of(|account| account.mean_distance),
            overshoot: of(|account| account.overshoot),
            calm: account.is_some_and(ApproximationReport::is_calm),
            corners: account.map_or(0, |account| account.corners.len()),
        }
    }

    fn json(&self) -> Value {
        json!({
            "tolerance": self.distance,
            "met": self.met,
            "control_points": self.control_points,
            "net": self.net,
            "max_distance": self.largest,
            "rms_distance": self.rms,
            "mean_distance": self.mean,
            "overshoot": self.overshoot,
            "calm": self.calm,
            "corners": self.corners,
        })
    }
}

/// Shows a fit, by its place in the list, as a product of its own.
type Show<'a> = dyn Fn(usize, &mut dyn FnMut(&mut dyn Product) -> anyhow::Result<()>) -> anyhow::Result<()>
    + 'a;

/// All fits, from few control points to many.
pub(super) struct Ladder<'a> {
    pub(super) source: &'a str,
    pub(super) title: Option<&'a str>,
    /// What was read.
    pub(super) read: String,
    pub(super) notes: &'a [String],
    /// What all fits have in common.
    pub(super) kind: String,
    pub(super) choices: Vec<Choice>,
    pub(super) seconds: Seconds,
    /// The command that makes one of them.
    pub(super) command: &'static str,
    pub(super) job: &'a Show<'a>,
}

impl Product for Ladder<'_> {
    fn svg(&self) -> String {
        let kept: Vec<&Choice> = self.choices.iter().filter(|choice| choice.met).collect();
        let sizes: Vec<usize> = kept.iter().map(|choice| choice.control_points).collect();
        let largest: Vec<f64> = kept.iter().map(|choice| choice.largest).collect();
        let rms: Vec<f64> = kept.iter().map(|choice| choice.rms).collect();
        choices_figure_svg(&ChoicesFigure {
            title: self.title.unwrap_or(self.source),
            caption: &format!("{}, {}, {} fits to choose from", self.read, self.kind, kept.len()),
            control_points: &sizes,
            largest: &largest,
            rms: &rms,
        })
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<String> {
        writeln!(
            out,
            "tolerance,met,control_points,rows,columns,max_distance,rms_distance,mean_distance,\
             overshoot,calm,corners"
        )?;
        for choice in &self.choices {
            let net =
                choice.net.map_or(",".to_owned(), |[rows, columns]| format!("{rows},{columns}"));
            writeln!(
                out,
                "{},{},{},{net},{},{},{},{},{},{}",
                choice.distance,
                choice.met,
                choice.control_points,
                choice.largest,
                choice.rms,
                choice.mean,
                choice.overshoot,
                choice.calm,
                choice.corners
            )?;
        }
        Ok(format!("{} fits, a line each", self.choices.len()))
    }

    fn json(&self, _geometry: bool) -> anyhow::Result<String> {
        let choices: Vec<Value> = self.choices.iter().map(Choice::json).collect();
        let seconds = json!({ "read": self.seconds.read, "fit": self.seconds.fit });
        let all = json!({ "source": self.source, "choices": choices, "seconds": seconds });
        Ok(all.to_string() + "\n")
    }

    fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(self.json(false).map_err(io::Error::other)?.as_bytes())
    }

    fn set_write_time(&mut self, seconds: f64) {
        self.seconds.write = Some(seconds);
    }

    fn each_member(
        &self,
        visit: &mut dyn FnMut(usize, &mut dyn Product) -> anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        for (k, choice) in self.choices.iter().enumerate().filter(|(_, choice)| choice.met) {
            (self.job)(k, &mut |product| visit(choice.control_points, product))?;
        }
        Ok(())
    }
}
