//! Commands that take points, or with `--grid` a grid: grids have options of their own, so that each of
//! them is two commands.

use std::ffi::OsString;

/// The command that `gimfit diagnose --grid` is.
pub(crate) const GRID_DIAGNOSIS: &str = "diagnose-grid";
/// The command that `gimfit choose --grid` is.
pub(crate) const GRID_CHOICES: &str = "choose-grid";

const ROUTES: [(&str, &str); 2] = [("diagnose", GRID_DIAGNOSIS), ("choose", GRID_CHOICES)];

/// The arguments with such a command and `--grid` taken for one command.
pub(crate) fn routed(arguments: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut all: Vec<OsString> = arguments.collect();
    let Some((_, route)) = ROUTES.iter().find(|(name, _)| all.get(1).is_some_and(|a| a == name))
    else {
        return all;
    };
    let options = all.iter().position(|one| one == "--").unwrap_or(all.len());
    if let Some(grid) = all[..options].iter().skip(2).position(|one| one == "--grid") {
        all.remove(2 + grid);
        all[1] = route.into();
    }
    all
}
