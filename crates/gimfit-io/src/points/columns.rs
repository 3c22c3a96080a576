//! Which columns of a file become coordinates, and which the abscissa.

use super::error::{Problem, ReadError, list};
use super::options::{ColumnChoice, ReadOptions};

/// The most columns of one file. A curve in so many dimensions is a mistake
/// about the layout, and their names would outgrow the file.
pub(crate) const MOST_COLUMNS: usize = 10_000;

/// The columns a file has, and those taken when nobody chooses.
pub(crate) struct Offer<'a> {
    pub(crate) names: &'a [String],
    /// Whether the file gives the names itself.
    pub(crate) named: bool,
    /// The columns taken without a choice.
    pub(crate) usual: Vec<usize>,
    /// Why they are taken, where they are not all. If empty, the caller says
    /// itself what was left out.
    pub(crate) why: &'a str,
}

/// The columns to read, by index.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Selection {
    pub(crate) coordinates: Vec<usize>,
    pub(crate) abscissa: Option<usize>,
}

impl Selection {
    /// Every column to read, once or more.
    pub(super) fn all(&self) -> impl Iterator<Item = usize> + '_ {
        self.coordinates.iter().copied().chain(self.abscissa)
    }

    /// The numbers of the selected columns, row by row, and of the abscissa;
    /// `value` gives the one in a row and a column.
    pub(crate) fn gather<E>(
        &self,
        rows: usize,
        mut value: impl FnMut(usize, usize) -> Result<f64, E>,
    ) -> Result<(Vec<f64>, Option<Vec<f64>>), E> {
        let mut coordinates = Vec::with_capacity(rows.saturating_mul(self.coordinates.len()));
        let mut abscissa = self.abscissa.map(|_| Vec::with_capacity(rows));
        for row in 0..rows {
            for column in &self.coordinates {
                coordinates.push(value(row, *column)?);
            }
            if let (Some(out), Some(column)) = (&mut abscissa, self.abscissa) {
                out.push(value(row, column)?);
            }
        }
        Ok((coordinates, abscissa))
    }

    /// The names of the coordinate columns.
    pub(crate) fn coordinate_names(&self, names: &[String]) -> Vec<String> {
        self.coordinates.iter().map(|at| names[*at].clone()).collect()
    }

    /// The name of the abscissa column.
    pub(super) fn abscissa_name(&self, names: &[String]) -> Option<String> {
        self.abscissa.map(|at| names[at].clone())
    }
}

/// The columns to read of `offer`, as `options` ask.
pub(crate) fn select(
    offer: Offer<'_>,
    options: &ReadOptions,
    source: &str,
    notes: &mut Vec<String>,
) -> Result<Selection, ReadError> {
    let find = |choice| find(choice, &offer).map_err(|problem| ReadError::file(source, problem));
    let refuse = |text: String| Err(ReadError::file(source, Problem::Columns(text)));
    let abscissa = options.abscissa.as_ref().map(find).transpose()?;
    let Some(choices) = &options.columns else {
        let mut coordinates = offer.usual.clone();
        coordinates.retain(|at| Some(*at) != abscissa);
        if coordinates.is_empty() {
            return refuse(format!(
                "no column is left for the coordinates; the columns are {}",
                there(&offer)
            ));
        }
        note_left_out(&offer, &coordinates, abscissa, notes);
        return Ok(Selection { coordinates, abscissa });
    };
    let mut coordinates = Vec::with_capacity(choices.len());
    let mut taken = vec![false; offer.names.len()];
    for choice in choices {
        let at = find(choice)?;
        if std::mem::replace(&mut taken[at], true) {
            return refuse(format!("the column {choice} is chosen twice; choose it once"));
        }
        coordinates.push(at);
    }
    if coordinates.is_empty() {
        return refuse("the choice of columns is empty; choose at least one".to_owned());
    }
    Ok(Selection { coordinates, abscissa })
}

fn note_left_out(
    offer: &Offer<'_>,
    coordinates: &[usize],
    abscissa: Option<usize>,
    notes: &mut Vec<String>,
) {
    if coordinates.len() == offer.names.len() {
        return;
    }
    let names = |wanted: &dyn Fn(usize) -> bool| -> Vec<&str> {
        (0..offer.names.len()).filter(|at| wanted(*at)).map(|at| offer.names[at].as_str()).collect()
    };
    let left_out = names(&|at| !coordinates.contains(&at) && abscissa != Some(at));
    if left_out.is_empty() || offer.why.is_empty() {
        return;
    }
    let taken: Vec<&str> = coordinates.iter().map(|at| offer.names[*at].as_str()).collect();
    notes.push(format!(
        "The coordinates are {}, {}; left out: {}.",
        list(&taken),
        offer.why,
        list(&left_out)
    ));
}

/// The index of the column that `choice` means.
fn find(choice: &ColumnChoice, offer: &Offer<'_>) -> Result<usize, Problem> {
    let unknown = || Problem::UnknownColumn { asked: choice.to_string(), there: there(offer) };
    match choice {
        ColumnChoice::Number(number) => {
            number.checked_sub(1).filter(|at| *at < offer.names.len()).ok_or_else(unknown)
        }
        ColumnChoice::Name(name) => {
            let lower = name.to_lowercase();
            let alike: Vec<usize> = (0..offer.names.len())
                .filter(|at| offer.names[*at].to_lowercase() == lower)
                .collect();
            let exact: Vec<usize> =
                alike.iter().copied().filter(|at| offer.names[*at] == *name).collect();
            match (alike.as_slice(), exact.as_slice()) {
                ([], _) => Err(unknown()),
                ([one], _) | (_, [one]) => Ok(*one),
                (several, _) => {
                    let numbers: Vec<String> =
                        several.iter().map(|at| (at + 1).to_string()).collect();
                    Err(Problem::Columns(format!(
                        "several columns are named {choice}; choose one by its number: {}",
                        list(&numbers)
                    )))
                }
            }
        }
    }
}

fn there(offer: &Offer<'_>) -> String {
    match (offer.named, offer.names.len()) {
        (true, _) => list(offer.names),
        (false, 1) => "one, number 1, without a name".to_owned(),
        (false, count) => format!("numbered 1 to {count}, without names"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pick(names: &[&str], options: &ReadOptions) -> Result<(Selection, Vec<String>), String> {
        let names: Vec<String> = names.iter().map(|n| (*n).to_owned()).collect();
        let offer = Offer {
            names: &names,
            named: true,
            usual: (0..names.len().min(2)).collect(),
            why: "the first two",
        };
        let mut notes = Vec::new();
        let selection = select(offer, options, "f", &mut notes).map_err(|e| e.to_string())?;
        Ok((selection, notes))
    }

    fn asked(columns: &[&str], abscissa: Option<&str>) -> ReadOptions {
        ReadOptions {
            columns: (!columns.is_empty())
                .then(|| columns.iter().map(|c| c.parse().unwrap()).collect()),
            abscissa: abscissa.map(|a| a.parse().unwrap()),
            ..ReadOptions::default()
        }
    }

    #[test]
    fn the_usual_columns_are_taken_and_the_others_noted() {
        let (selection, notes) = pick(&["x", "y", "t"], &asked(&[], None)).unwrap();
        assert_eq!(selection.coordinates, [0, 1]);
        assert_eq!(notes, ["The coordinates are x, y, the first two; left out: t."]);
    }

    #[test]
    fn the_abscissa_leaves_the_usual_columns_but_not_chosen_ones() {
        let (selection, _) = pick(&["x", "y", "t"], &asked(&[], Some("X"))).unwrap();
        assert_eq!((selection.coordinates, selection.abscissa), (vec![1], Some(0)));
        let (selection, _) = pick(&["x", "y", "t"], &asked(&["t", "1"], Some("t"))).unwrap();
        assert_eq!((selection.coordinates, selection.abscissa), (vec![2, 0], Some(2)));
    }

    #[test]
    fn choices_that_fit_no_column_or_several_are_refused() {
        let error = pick(&["x", "y"], &asked(&["z"], None)).unwrap_err();
        assert_eq!(error, "f: there is no column \"z\"; the columns are x, y");
        assert!(pick(&["x", "y"], &asked(&["3"], None)).is_err());
        assert!(pick(&["x", "X"], &asked(&["1", "x"], None)).unwrap_err().contains("twice"));
        assert!(pick(&["a", "a"], &asked(&["A"], None)).unwrap_err().contains("1, 2"));
        assert_eq!(pick(&["a", "A"], &asked(&["A"], None)).unwrap().0.coordinates, [1]);
        assert!(pick(&["a"], &asked(&[], Some("a"))).unwrap_err().contains("no column is left"));
    }
}
