//! Published tables, recomputed and shown beside the paper.

mod bases;
mod chen2012;
mod functions2007;
mod lin2004;
mod lin2010;
mod measure;
mod orsi2021;
mod peng_li;
mod spectra;
mod table;
mod wang2007;

use crate::Ending;
use crate::arguments::ReproduceArguments;
use crate::output;
use anyhow::bail;
use std::fmt::Write;
use table::Table;

/// A table that can be asked for.
struct Reproduction {
    name: &'static str,
    line: &'static str,
    recompute: fn() -> anyhow::Result<Table>,
}

const REPRODUCTIONS: [Reproduction; 9] = [
    Reproduction {
        name: "wang2007",
        line: "Wang, Li, Jiang and Li 2007, Table 1: closed quadratic curve, 15 passes",
        recompute: wang2007::recompute,
    },
    Reproduction {
        name: "functions2007",
        line: "Wang, Li, Jiang and Li 2007, section 5.2: three functions, measured errors",
        recompute: functions2007::recompute,
    },
    Reproduction {
        name: "lin2004",
        line: "Lin, Wang and Dong 2004, Table 1, Fig. 6: a surface through MATLAB's peaks",
        recompute: lin2004::recompute,
    },
    Reproduction {
        name: "chen2012",
        line: "Chen, Wang and Jin 2012, Tables 1 to 3: Wang-Ball curve; weights per point",
        recompute: chen2012::recompute,
    },
    Reproduction {
        name: "lin2010",
        line: "Lin 2010: geometric interpolation, recomputed independently",
        recompute: lin2010::recompute,
    },
    Reproduction {
        name: "orsi2021",
        line: "Orsi 2021, Tables 2.1, 2.2, 2.4: lemniscate, plain and weighted PIA",
        recompute: orsi2021::recompute,
    },
    Reproduction {
        name: "peng-li",
        line: "Peng and Li: steps of LSPIA and its relatives on a curve, a surface, a curve with gaps",
        recompute: peng_li::recompute,
    },
    Reproduction {
        name: "spectra",
        line: "Theory: smallest eigenvalues, weights, rates and poles for degrees 2 to 7",
        recompute: spectra::recompute,
    },
    Reproduction {
        name: "bases",
        line: "Other bases: smallest eigenvalues",
        recompute: bases::recompute,
    },
];

/// Prints the tables asked for; an entry that should agree and does not makes the run fail.
pub(crate) fn run(arguments: &ReproduceArguments) -> anyhow::Result<Ending> {
    let chosen = choose(&arguments.tables)?;
    if arguments.list {
        let mut text = String::new();
        for reproduction in chosen {
            writeln!(text, "{:<14} {}", reproduction.name, reproduction.line)?;
        }
        output::text(&text)?;
        return Ok(Ending::Done);
    }
    let mut text = String::new();
    let mut summaries = String::new();
    let mut met = true;
    for reproduction in chosen {
        let table = (reproduction.recompute)()?;
        writeln!(text, "{}\n", table.text(reproduction.name))?;
        summaries += &table.summary(reproduction.name);
        met &= table.agrees();
    }
    output::text(&(text + &summaries))?;
    Ok(if met { Ending::Done } else { Ending::NotMet })
}

/// The tables of these names, in this order; all if there are none.
fn choose(names: &[String]) -> anyhow::Result<Vec<&'static Reproduction>> {
    if names.is_empty() {
        return Ok(REPRODUCTIONS.iter().collect());
    }
    let mut chosen = Vec::new();
    for name in names {
        match REPRODUCTIONS.iter().find(|reproduction| reproduction.name == name) {
            Some(reproduction) => chosen.push(reproduction),
            None => {
                let known: Vec<&str> = REPRODUCTIONS.iter().map(|r| r.name).collect();
                bail!("there is no table '{name}'; the tables are {}", known.join(", "));
            }
        }
    }
    Ok(chosen)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_agrees_in_lines_that_fit_into_100_columns() {
        for reproduction in &REPRODUCTIONS {
            let table = (reproduction.recompute)().unwrap();
            let name = reproduction.name;
            let text = table.text(name) + &table.summary(name);
            assert!(table.agrees(), "{text}");
            assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
        }
    }

    #[test]
    fn an_unknown_name_is_told_the_known_ones() {
        let error = choose(&["wang2008".into()]).err().unwrap().to_string();
        assert!(error.contains("wang2008") && error.contains("wang2007"), "{error}");
        assert_eq!(choose(&[]).unwrap().len(), REPRODUCTIONS.len());
    }
}
