//! Decimal numbers between white space and comments, as in the text parts of netpbm files.

use std::io::{self, BufRead};

use super::error::Place;

/// Longest piece of a file that is repeated in a message, bytes.
const QUOTE: usize = 20;

/// What stands where a number may stand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Token {
    /// A number that fits.
    Number(u32),
    /// Something else, or a number that does not fit; quoted for a message.
    Junk(String),
    /// The file ends.
    End,
}

/// Reads tokens one by one and keeps track of lines and columns.
#[derive(Debug)]
pub(super) struct Numbers<R> {
    input: R,
    offset: u64,
    line: u64,
    column: u64,
    token_line: u64,
    token_column: u64,
}

impl<R: BufRead> Numbers<R> {
    /// Starts at the beginning of a file.
    pub(super) fn new(input: R) -> Self {
        Self { input, offset: 0, line: 1, column: 1, token_line: 1, token_column: 1 }
    }

    /// Where the last token starts.
    pub(super) fn place(&self) -> Place {
        Place::Text { line: self.token_line, column: self.token_column }
    }

    /// Bytes read so far.
    pub(super) fn offset(&self) -> u64 {
        self.offset
    }

    /// The input after the last token and the one white-space character that ended it.
    pub(super) fn into_rest(self) -> R {
        self.input
    }

    /// The next byte as it is.
    pub(super) fn byte(&mut self) -> io::Result<Option<u8>> {
        let byte = loop {
            match self.input.fill_buf() {
                Ok(buffer) => break buffer.first().copied(),
                Err(cause) if cause.kind() == io::ErrorKind::Interrupted => {}
                Err(cause) => return Err(cause),
            }
        };
        if let Some(byte) = byte {
            self.input.consume(1);
            self.offset += 1;
            if byte == b'\n' {
                self.line += 1;
                self.column = 1;
            } else {
                self.column += 1;
            }
        }
        Ok(byte)
    }

    /// The next token. The white-space character after it is used up, a comment right
    /// behind it counts as one.
    pub(super) fn token(&mut self) -> io::Result<Token> {
        let first = loop {
            (self.token_line, self.token_column) = (self.line, self.column);
            match self.byte_or_comment()? {
                None => return Ok(Token::End),
                Some(byte) if is_space(byte) => {}
                Some(byte) => break byte,
            }
        };
        let mut quote = vec![first];
        let mut value = digit(first);
        while let Some(byte) = self.byte_or_comment()? {
            if is_space(byte) {
                break;
            }
            if quote.len() == QUOTE {
                value = None;
                break;
            }
            quote.push(byte);
            value = value
                .zip(digit(byte))
                .and_then(|(value, digit)| value.checked_mul(10)?.checked_add(digit));
        }
        Ok(value.map_or_else(|| Token::Junk(format!("`{}`", quote.escape_ascii())), Token::Number))
    }

    /// The next byte; a comment reads as the line end that closes it.
    fn byte_or_comment(&mut self) -> io::Result<Option<u8>> {
        let byte = self.byte()?;
        if byte != Some(b'#') {
            return Ok(byte);
        }
        loop {
            match self.byte()? {
                Some(b'\n' | b'\r') => return Ok(Some(b'\n')),
                None => return Ok(None),
                Some(_) => {}
            }
        }
    }
}

fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | 0x0b | 0x0c)
}

fn digit(byte: u8) -> Option<u32> {
    char::from(byte).to_digit(10)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str) -> Vec<(Token, Place)> {
        let mut numbers = Numbers::new(text.as_bytes());
        let mut found = Vec::new();
        loop {
            let token = numbers.token().unwrap();
            let last = token == Token::End;
            found.push((token, numbers.place()));
            if last {
                return found;
            }
        }
    }

    fn at(line: u64, column: u64) -> Place {
        Place::Text { line, column }
    }

    #[test]
    fn numbers_come_with_their_line_and_column_and_comments_are_skipped() {
        assert_eq!(
            tokens("12 # width\n\t7#height\n255"),
            [
                (Token::Number(12), at(1, 1)),
                (Token::Number(7), at(2, 2)),
                (Token::Number(255), at(3, 1)),
                (Token::End, at(3, 4)),
            ]
        );
    }

    #[test]
    fn what_is_no_number_is_quoted_and_cut_short() {
        let long = "9".repeat(1000);
        assert_eq!(
            tokens("-3 4x 4294967296")[..3],
            [
                (Token::Junk("`-3`".into()), at(1, 1)),
                (Token::Junk("`4x`".into()), at(1, 4)),
                (Token::Junk("`4294967296`".into()), at(1, 7)),
            ]
        );
        assert_eq!(tokens(&long)[0].0, Token::Junk(format!("`{}`", "9".repeat(QUOTE))));
    }
}
