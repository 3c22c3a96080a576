//! The program `gimfit`: raw arguments, then a checked plan, then the run, then what is printed.

mod arguments;
mod basis;
mod choose;
mod complete;
mod curve;
mod diagnose;
mod evaluate;
mod explain;
mod family;
mod finish;
mod info;
mod input;
mod method;
mod output;
mod outputs;
mod progress;
mod project;
mod report_text;
mod reproduce;
mod routes;
mod shape;
mod signal;
mod surface;
mod targets;
mod triangle;
mod values;

use arguments::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

/// How a run that raised no error ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ending {
    /// Done.
    Done,
    /// A result was written, but it is not what was asked for.
    NotMet,
}

fn main() -> ExitCode {
    let arguments = Arguments::try_parse_from(routes::routed(std::env::args_os()))
        .unwrap_or_else(|error| output::usage(&error));
    let result = match arguments.command {
        Command::Curve(arguments) => curve::run(&arguments),
        Command::Edit(arguments) => curve::edit::run(&arguments),
        Command::Surface(arguments) => surface::run(&arguments),
        Command::Diagnose(arguments) => diagnose::run(&arguments),
        Command::DiagnoseGrid(arguments) => diagnose::grid::run(&arguments),
        Command::Choose(arguments) => choose::run(&arguments),
        Command::ChooseGrid(arguments) => choose::run_grid(&arguments),
        Command::Triangle(arguments) => triangle::run(&arguments),
        Command::Evaluate(arguments) => evaluate::run(&arguments),
        Command::Project(arguments) => project::run(&arguments),
        Command::Info(arguments) => info::run(&arguments),
        Command::Reproduce(arguments) => reproduce::run(&arguments),
        Command::Completions(arguments) => complete::completions(&arguments),
        Command::Manual(arguments) => complete::manual(&arguments),
    };
    match result {
        Ok(Ending::Done) => ExitCode::SUCCESS,
        Ok(Ending::NotMet) => ExitCode::from(1),
        // Whoever reads our output has read enough.
        Err(error) if output::is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            output::error(&error);
            ExitCode::from(2)
        }
    }
}
