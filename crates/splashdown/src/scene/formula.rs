//! Formulas of the time t, which describe motions in scene files: `0.1 * sin(2 * pi * t)`.
//!
//! Why not a crate: the grammar is small (numbers, `t`, `pi`, + - * / ^, brackets and a dozen functions),
//! evalexpr is under the AGPL, and meval and fasteval are no longer maintained.

/// A formula that can be evaluated at any time.
#[derive(Debug, Clone)]
pub struct Formula {
    text: String,
    /// Operations in postfix order.
    code: Vec<Op>,
}

impl PartialEq for Formula {
    /// Formulas are equal if their texts are equal.
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

#[derive(Debug, Clone, Copy)]
enum Op {
    Number(f64),
    Time,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Negate,
    Call(fn(f64) -> f64),
    Call2(fn(f64, f64) -> f64),
}

type Function = (&'static str, fn(f64) -> f64);
type FunctionOfTwo = (&'static str, fn(f64, f64) -> f64);

const FUNCTIONS: &[Function] = &[
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("sqrt", f64::sqrt),
    ("exp", f64::exp),
    ("log", f64::ln),
    ("abs", f64::abs),
    ("tanh", f64::tanh),
    ("floor", f64::floor),
];
const FUNCTIONS_OF_TWO: &[FunctionOfTwo] = &[("min", f64::min), ("max", f64::max)];

/// The allowed elements of a formula, for messages.
pub(crate) const ALLOWED: &str =
    "numbers, t (seconds), pi, + - * / ^ ( ), sin cos tan sqrt exp log abs tanh floor min max";

/// Maximum depth of nested brackets and signs.
const MAX_DEPTH: u32 = 64;

impl Formula {
    /// Parses a formula.
    ///
    /// # Errors
    /// A message that names the problem and its position.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut parser = Parser { text, at: 0, code: Vec::new(), depth: 0 };
        parser.sum()?;
        match parser.peek() {
            None => Ok(Self { text: text.to_owned(), code: parser.code }),
            Some(c) => Err(format!("unexpected {c:?} at position {} of {text:?}", parser.at + 1)),
        }
    }

    /// The value at `t` seconds.
    pub fn at(&self, t: f64) -> f64 {
        let mut stack = Vec::with_capacity(8);
        for op in &self.code {
            let mut pop = || stack.pop().unwrap_or(f64::NAN);
            let value = match *op {
                Op::Number(value) => value,
                Op::Time => t,
                Op::Negate => -pop(),
                Op::Call(f) => f(pop()),
                two => {
                    let (b, a) = (pop(), pop());
                    match two {
                        Op::Add => a + b,
                        Op::Subtract => a - b,
                        Op::Multiply => a * b,
                        Op::Divide => a / b,
                        Op::Power => a.powf(b),
                        Op::Call2(f) => f(a, b),
                        _ => f64::NAN,
                    }
                }
            };
            stack.push(value);
        }
        stack.pop().unwrap_or(f64::NAN)
    }

    /// Searches [0, `end`] (s) for a time at which the formula is not finite or its absolute value exceeds
    /// `limit`. It tests equidistant samples, and searches for a pole near the samples with the largest
    /// values.
    pub(crate) fn fault(&self, end: f64, limit: f64) -> Option<f64> {
        const SAMPLES: usize = 2000;
        const PEAKS: usize = 8;
        const ROUNDS: u32 = 64;
        let bad = |t: f64| !matches!(self.at(t).abs(), size if size <= limit);
        let step = end / SAMPLES as f64;
        let times: Vec<f64> = (0..=SAMPLES).map(|k| (step * k as f64).min(end)).collect();
        if let Some(&t) = times.iter().find(|&&t| bad(t)) {
            return Some(t);
        }
        let size: Vec<f64> = times.iter().map(|&t| self.at(t).abs()).collect();
        let is_peak =
            |k: &usize| size[*k] >= size[k.saturating_sub(1)] && size[*k] >= size[(k + 1).min(SAMPLES)];
        let mut peaks: Vec<usize> = (0..=SAMPLES).filter(is_peak).collect();
        peaks.sort_by(|a, b| size[*b].total_cmp(&size[*a]));
        peaks.into_iter().take(PEAKS).find_map(|k| {
            let (mut low, mut high) = ((times[k] - step).max(0.0), (times[k] + step).min(end));
            for _ in 0..ROUNDS {
                let third = (high - low) / 3.0;
                let (a, b) = (low + third, high - third);
                if let Some(t) = [a, b].into_iter().find(|&t| bad(t)) {
                    return Some(t);
                }
                if self.at(a).abs() < self.at(b).abs() { low = a } else { high = b }
            }
            None
        })
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    code: Vec<Op>,
    depth: u32,
}

impl Parser<'_> {
    /// The next character that is not a space.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.at += wanted.len_utf8();
        }
        found
    }

    fn sum(&mut self) -> Result<(), String> {
        self.product()?;
        loop {
            let op = if self.take('+') {
                Op::Add
            } else if self.take('-') {
                Op::Subtract
            } else {
                return Ok(());
            };
            self.product()?;
            self.code.push(op);
        }
    }

    fn product(&mut self) -> Result<(), String> {
        self.signed()?;
        loop {
            let op = if self.take('*') {
                Op::Multiply
            } else if self.take('/') {
                Op::Divide
            } else {
                return Ok(());
            };
            self.signed()?;
            self.code.push(op);
        }
    }

    fn signed(&mut self) -> Result<(), String> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(format!("it is nested more than {MAX_DEPTH} levels deep"));
        }
        let done =
            if self.take('-') { self.signed().map(|()| self.code.push(Op::Negate)) } else { self.power() };
        self.depth -= 1;
        done
    }

    fn power(&mut self) -> Result<(), String> {
        self.value()?;
        if self.take('^') {
            self.signed()?;
            self.code.push(Op::Power);
        }
        Ok(())
    }

    fn value(&mut self) -> Result<(), String> {
        let Some(c) = self.peek() else {
            return Err(format!("{:?} ends where a value was expected", self.text));
        };
        let rest = &self.text[self.at..];
        if self.take('(') {
            self.sum()?;
            return self.expect(')');
        }
        if c.is_ascii_digit() || c == '.' {
            let length = number_length(rest);
            let digits = &rest[..length];
            let value: f64 = digits.parse().map_err(|_| format!("{digits:?} is not a number"))?;
            self.at += length;
            self.code.push(Op::Number(value));
            return Ok(());
        }
        let word: String = rest.chars().take_while(char::is_ascii_alphanumeric).collect();
        let position = self.at + 1;
        self.at += word.len();
        if let Some(&(_, f)) = FUNCTIONS.iter().find(|(name, _)| *name == word) {
            self.expect('(')?;
            self.sum()?;
            self.expect(')')?;
            self.code.push(Op::Call(f));
        } else if let Some(&(_, f)) = FUNCTIONS_OF_TWO.iter().find(|(name, _)| *name == word) {
            self.expect('(')?;
            self.sum()?;
            self.expect(',')?;
            self.sum()?;
            self.expect(')')?;
            self.code.push(Op::Call2(f));
        } else {
            self.code.push(match word.as_str() {
                "t" => Op::Time,
                "pi" => Op::Number(std::f64::consts::PI),
                "" => return Err(format!("unexpected {c:?} at position {position} of {:?}", self.text)),
                _ => return Err(format!("unknown name {word:?} at position {position} of {:?}", self.text)),
            });
        }
        Ok(())
    }

    fn expect(&mut self, wanted: char) -> Result<(), String> {
        if self.take(wanted) {
            return Ok(());
        }
        Err(format!("{wanted:?} is missing at position {} of {:?}", self.at + 1, self.text))
    }
}

/// The length in bytes of the number at the start of a text, including its exponent.
fn number_length(text: &str) -> usize {
    let digits = |text: &str| text.bytes().take_while(|b| b.is_ascii_digit() || *b == b'.').count();
    let mantissa = digits(text);
    let rest = &text[mantissa..];
    let sign = usize::from(rest.len() > 1 && matches!(rest.as_bytes()[1], b'+' | b'-'));
    let exponent = rest.get(1 + sign..).map_or(0, digits);
    if rest.starts_with(['e', 'E']) && exponent > 0 { mantissa + 1 + sign + exponent } else { mantissa }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_evaluated_by_the_rules_of_arithmetic() {
        for (text, value) in [
            ("1 + 2 * 3", 7.0),
            ("-2 ^ 2", -4.0),
            ("2 ^ -1", 0.5),
            ("2 ^ 3 ^ 2", 512.0),
            ("(1 - 2) - 3", -4.0),
            ("8 / 2 / 2", 2.0),
            ("0.1*sin(2*pi*t)", 0.1 * (std::f64::consts::PI).sin()),
            ("max(t, 3) + min(t, 3)", 3.5),
            ("1e-3*t + 2.5E2", 250.0005),
            ("- -t", 0.5),
        ] {
            let got = Formula::parse(text).unwrap().at(0.5);
            assert!((got - value).abs() < 1e-12, "{text}: {got}");
        }
    }

    #[test]
    fn values_that_are_not_finite_or_too_large_are_found() {
        for (text, at) in [
            ("1/t", 0.0),
            ("sqrt(0.5-t)", 0.5),
            ("log(t)", 0.0),
            ("1/(t-1)", 1.0),
            ("0.01/(t-0.12345)^2", 0.12345),
            ("tan(t)", std::f64::consts::FRAC_PI_2),
            ("exp(20*t)", 0.691),
            ("sqrt(-1-t)", 0.0),
        ] {
            let found = Formula::parse(text).unwrap().fault(2.0, 1e6);
            assert!(found.is_some_and(|t| (t - at).abs() < 2e-3), "{text}: {found:?}");
        }
        for text in
            ["t", "1/(t+0.01)", "sqrt(t)", "100*sin(1000*t)", "tan(t/2)", "1/max(t-1, 0.001)", "floor(t)"]
        {
            assert_eq!(Formula::parse(text).unwrap().fault(2.0, 1e6), None, "{text}");
        }
        assert_eq!(
            Formula::parse("1/(t-3)").unwrap().fault(2.0, 1e6),
            None,
            "control: the pole is after the end"
        );
    }

    #[test]
    fn invalid_formulas_are_rejected_with_a_position() {
        for (text, part) in [
            ("", "ends"),
            ("2 *", "ends"),
            ("2 3", "position 3"),
            ("sin t", "'('"),
            ("foo(2)", "\"foo\" at position 1"),
            ("(1", "')'"),
            ("1 ; 2", "';'"),
            ("1.2.3", "not a number"),
            ("é", "position 1"),
        ] {
            let error = Formula::parse(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
        assert!(Formula::parse(&"(".repeat(1000)).is_err());
        assert!(Formula::parse(&"-".repeat(1000)).is_err());
    }
}
