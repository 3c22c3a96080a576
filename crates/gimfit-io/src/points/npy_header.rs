//! The header of a NumPy array file: a Python literal with three entries.

/// What the header says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Header {
    /// The kind of number, such as `<f8`.
    pub(crate) descr: String,
    /// Whether the first index runs fastest.
    pub(crate) fortran_order: bool,
    /// The lengths along each axis.
    pub(crate) shape: Vec<u64>,
}

/// Reads `{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }`.
/// The error is a sentence without its file.
pub(super) fn parse(text: &str) -> Result<Header, String> {
    let mut scanner = Scanner { rest: text };
    let mut descr = None;
    let mut fortran_order = None;
    let mut shape = None;
    scanner.expect('{')?;
    while !scanner.take('}') {
        let key = scanner.string()?;
        scanner.expect(':')?;
        match key {
            "descr" if scanner.next_is('[') => {
                return Err(
                    "the array is structured (its rows are records of several kinds); save one \
                     plain array, such as numpy.column_stack of the fields"
                        .to_owned(),
                );
            }
            "descr" => descr = Some(scanner.string()?.to_owned()),
            "fortran_order" => fortran_order = Some(scanner.truth()?),
            "shape" => shape = Some(scanner.tuple()?),
            _ => return Err(broken("it has an unknown entry")),
        }
        if !scanner.take(',') {
            scanner.expect('}')?;
            break;
        }
    }
    match (descr, fortran_order, shape) {
        (Some(descr), Some(fortran_order), Some(shape)) => {
            Ok(Header { descr, fortran_order, shape })
        }
        _ => Err(broken("it lacks descr, fortran_order or shape")),
    }
}

fn broken(what: &str) -> String {
    format!("the header of the array is broken ({what}); save the array again with numpy.save")
}

struct Scanner<'a> {
    rest: &'a str,
}

impl<'a> Scanner<'a> {
    fn next_is(&mut self, wanted: char) -> bool {
        self.rest = self.rest.trim_ascii_start();
        self.rest.starts_with(wanted)
    }

    fn take(&mut self, wanted: char) -> bool {
        let is = self.next_is(wanted);
        if is {
            self.rest = &self.rest[wanted.len_utf8()..];
        }
        is
    }

    fn expect(&mut self, wanted: char) -> Result<(), String> {
        match self.take(wanted) {
            true => Ok(()),
            false => Err(broken(&format!("{wanted} is missing"))),
        }
    }

    fn string(&mut self) -> Result<&'a str, String> {
        let quote = if self.next_is('"') { '"' } else { '\'' };
        self.expect(quote)?;
        let (text, rest) =
            self.rest.split_once(quote).ok_or_else(|| broken("a string does not end"))?;
        self.rest = rest;
        Ok(text)
    }

    fn truth(&mut self) -> Result<bool, String> {
        self.rest = self.rest.trim_ascii_start();
        for (word, value) in [("True", true), ("False", false)] {
            if let Some(rest) = self.rest.strip_prefix(word) {
                self.rest = rest;
                return Ok(value);
            }
        }
        Err(broken("fortran_order is neither True nor False"))
    }

    fn tuple(&mut self) -> Result<Vec<u64>, String> {
        let mut out = Vec::new();
        self.expect('(')?;
        while !self.take(')') {
            self.rest = self.rest.trim_ascii_start();
            let end =
                self.rest.bytes().position(|b| !b.is_ascii_digit()).unwrap_or(self.rest.len());
            let (digits, rest) = self.rest.split_at(end);
            out.push(digits.parse().map_err(|_| broken("shape is not a tuple of whole numbers"))?);
            // Python 2 wrote long numbers as 3L.
            self.rest = rest.strip_prefix('L').unwrap_or(rest);
            if !self.take(',') {
                self.expect(')')?;
                break;
            }
        }
        Ok(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_as_numpy_writes_them_are_read() {
        let header = parse("{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }  \n");
        let expected = Header { descr: "<f8".to_owned(), fortran_order: false, shape: vec![3, 2] };
        assert_eq!(header, Ok(expected));
        let header = parse("{'shape': (5L,), 'fortran_order': True, 'descr': \"|u1\"}").unwrap();
        assert_eq!((header.shape, header.fortran_order), (vec![5], true));
        assert_eq!(
            parse("{'descr':'<i2','fortran_order':False,'shape':()}").unwrap().shape,
            Vec::<u64>::new()
        );
    }

    #[test]
    fn broken_headers_are_refused() {
        for text in [
            "",
            "{",
            "{'descr': '<f8'}",
            "{'descr': '<f8, 'fortran_order'",
            "{'descr': '<f8', 'fortran_order': 0, 'shape': (1,)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (1,-2)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999,)}",
            "{'other': '<f8'}",
        ] {
            assert!(parse(text).unwrap_err().contains("broken"), "{text}");
        }
        let error = parse("{'descr': [('x', '<f8')], 'fortran_order'").unwrap_err();
        assert!(error.contains("structured"), "{error}");
    }
}
