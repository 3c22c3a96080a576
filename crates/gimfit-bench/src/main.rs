//! The program `gimfit-bench`: gimfit's side of comparisons with other libraries.
//!
//! `--list` prints the cases as lines `workload<TAB>peer<TAB>sizes<TAB>note`; a case, given as
//! `<workload> <peer> <size>`, prints one line `RESULT {json}`.

use anyhow::{bail, ensure};
use clap::Parser;
use gimfit_bench::report::{self, PEER};
use gimfit_bench::workload::Workload;
use gimfit_bench::{edit, edit_surface, least_squares, nearest, surface};
use std::io::Write;
use std::path::PathBuf;

const SIZES: &str = "100,1000,10000,100000,1000000,10000000";

#[derive(Debug, Parser)]
#[command(about = "Times gimfit on data in $BENCH_DATA (or bench-data in the temporary folder)")]
struct Arguments {
    /// Print the cases
    #[arg(long, exclusive = true)]
    list: bool,
    /// W1, W2 or W3, then gimfit.interpolate, then the number of points (of W3: in a row); or W4,
    /// gimfit.least_squares, and the number of points; or W7, gimfit.nearest, and the number of
    /// queries; or W10 or W10-grid, gimfit.edit, and the number of points, of a grid in a row
    #[arg(value_names = ["WORKLOAD", "PEER", "SIZE"], num_args = 3)]
    case: Vec<String>,
    /// How long to repeat the case; otherwise $BENCH_SECONDS, or 3
    #[arg(long)]
    seconds: Option<f64>,
    /// File that receives the control points (of W7: the distances) as raw little-endian doubles
    #[arg(long, value_name = "FILE")]
    control_points: Option<PathBuf>,
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let mut output = std::io::stdout().lock();
    if arguments.list {
        for workload in Workload::ALL {
            writeln!(output, "{}\t{PEER}\t{SIZES}\t{}", workload.name(), workload.note())?;
        }
        writeln!(output, "{}\t{PEER}\t{}\t{}", surface::NAME, surface::SIZES, surface::NOTE)?;
        let (name, peer) = (least_squares::NAME, least_squares::PEER);
        writeln!(output, "{name}\t{peer}\t{}\t{}", least_squares::SIZES, least_squares::NOTE)?;
        let (name, peer) = (nearest::NAME, nearest::PEER);
        writeln!(output, "{name}\t{peer}\t{}\t{}", nearest::SIZES, nearest::NOTE)?;
        let (name, peer) = (edit::NAME, edit::PEER);
        writeln!(output, "{name}\t{peer}\t{}\t{}", edit::SIZES, edit::NOTE)?;
        let (name, note) = (edit_surface::NAME, edit_surface::NOTE);
        writeln!(output, "{name}\t{peer}\t{}\t{note}", edit_surface::SIZES)?;
        return Ok(());
    }
    let [workload, peer, size] = arguments.case.as_slice() else {
        bail!("a case is <workload> {PEER} <size>; --list prints them");
    };
    let expected = match workload.as_str() {
        nearest::NAME => nearest::PEER,
        edit::NAME | edit_surface::NAME => edit::PEER,
        least_squares::NAME => least_squares::PEER,
        _ => PEER,
    };
    ensure!(peer == expected, "there is no peer {peer}; ours is {expected}");
    let control_points = arguments.control_points.as_deref();
    let seconds = match (arguments.seconds, std::env::var("BENCH_SECONDS")) {
        (Some(seconds), _) => seconds,
        (None, Ok(text)) => text.parse()?,
        (None, Err(_)) => 3.0,
    };
    let result = match workload.as_str() {
        nearest::NAME => nearest::run(size, seconds, control_points)?,
        edit_surface::NAME => edit_surface::run(size, seconds, control_points)?,
        edit::NAME => edit::run(size, seconds, control_points)?,
        _ => report::run(workload, size, seconds, control_points)?,
    };
    writeln!(output, "RESULT {result}")?;
    Ok(())
}
