//! Edits on the command line: options of three names whose order counts.

use crate::values;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};

/// What happens to a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Move,
    Insert,
    Remove,
}

/// One edit as it was given.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Edit {
    pub(super) kind: Kind,
    /// Number of the point, from 1.
    pub(super) number: usize,
    /// Where it goes; of none that is removed.
    pub(super) point: Vec<f64>,
    /// The option and its value.
    pub(super) text: String,
}

/// All edits, in the order given.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Edits(pub(super) Vec<Edit>);

/// Names, what they take, and what they do.
const OPTIONS: [(Kind, &str, &str, &str); 3] = [
    (Kind::Move, "move", "N=X,Y,...", "Move point N to a place"),
    (
        Kind::Insert,
        "insert",
        "N=X,Y,...",
        "Insert a point that becomes point N; one more than there \
      are appends it",
    ),
    (Kind::Remove, "remove", "N", "Remove point N"),
];

/// A number of a point, from 1, and with `N=X,Y` where it goes.
fn edit(kind: Kind, name: &str, text: &str) -> Result<Edit, String> {
    let (number, place) = match (kind, text.split_once('=')) {
        (Kind::Remove, None) => (text, None),
        (Kind::Remove, Some(_)) => return Err("a point to remove takes its number only".into()),
        (_, Some((number, place))) => (number, Some(place)),
        (_, None) => return Err("it must be a number and a place, such as 12=3.5,-2".into()),
    };
    let number: usize =
        number.trim().parse().map_err(|_| format!("\"{number}\" is not the number of a point"))?;
    if number == 0 {
        return Err("points count from 1".into());
    }
    let point = place.map_or(Ok(Vec::new()), |place| {
        place.split(',').map(|part| values::number(part.trim())).collect()
    })?;
    Ok(Edit { kind, number, point, text: format!("--{name} {text}") })
}

impl Args for Edits {
    fn augment_args(command: Command) -> Command {
        command.args(OPTIONS.map(|(kind, name, value, help)| {
            Arg::new(name)
                .long(name)
                .value_name(value)
                .help(help)
                .help_heading("Edits")
                .action(ArgAction::Append)
                .value_parser(move |text: &str| edit(kind, name, text))
        }))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Edits {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut found: Vec<(usize, Edit)> = Vec::new();
        for (_, name, _, _) in OPTIONS {
            let places = matches.indices_of(name).into_iter().flatten();
            let values = matches.get_many::<Edit>(name).into_iter().flatten();
            found.extend(places.zip(values.cloned()));
        }
        found.sort_by_key(|(place, _)| *place);
        Ok(Self(found.into_iter().map(|(_, edit)| edit).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
