//! Shell completions and manual pages, made from the arguments themselves.

use crate::arguments::{Arguments, CompletionsArguments, ManualArguments};
use crate::{Ending, output};
use anyhow::Context;
use clap::CommandFactory;

/// Prints a completion script.
pub(crate) fn completions(arguments: &CompletionsArguments) -> anyhow::Result<Ending> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "gimfit", &mut script);
    output::data(&String::from_utf8_lossy(&script))?;
    Ok(Ending::Done)
}

/// Writes `gimfit.1` and a page for each command.
pub(crate) fn manual(arguments: &ManualArguments) -> anyhow::Result<Ending> {
    let folder = &arguments.folder;
    std::fs::create_dir_all(folder)
        .and_then(|()| clap_mangen::generate_to(Arguments::command(), folder))
        .with_context(|| format!("cannot write manual pages into {}", folder.display()))?;
    output::remark(&format!("wrote the manual pages into {}\n", folder.display()));
    Ok(Ending::Done)
}
