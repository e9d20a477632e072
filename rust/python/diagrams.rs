//! Diagrams, by their Gauss codes.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::errors::released;
use crate::diagrams::gauss::Gauss;
use crate::diagrams::{Diagram, exploring};

/// For each component the crossings it passes, from 1, negative where it does so below; and whether
/// each crossing is right-handed.
type Code = (Vec<Vec<i32>>, Vec<bool>);

fn diagram((passages, right): Code) -> PyResult<Diagram> {
    let passage = |number: i32| (number.unsigned_abs().wrapping_sub(1) as usize, number > 0);
    let along = |numbers: Vec<i32>| numbers.into_iter().map(passage).collect();
    let gauss = Gauss { passages: passages.into_iter().map(along).collect(), right };
    gauss.diagram().ok_or_else(|| PyValueError::new_err("the Gauss code is that of no diagram"))
}

fn code(diagram: &Diagram, components: usize) -> Code {
    let Gauss { passages, right } = diagram.gauss(components);
    let number = |(crossing, over): (usize, bool)| {
        let number = crossing as i32 + 1;
        if over { number } else { -number }
    };
    let along = |passages: Vec<_>| passages.into_iter().map(number).collect();
    (passages.into_iter().map(along).collect(), right)
}

fn code_of_part(mut part: Diagram) -> Code {
    let components = part.renumber();
    code(&part, components)
}

/// The diagram after passes to fewer crossings.
#[pyfunction]
pub fn shortened(py: Python<'_>, gauss: Code) -> PyResult<Code> {
    let components = gauss.0.len();
    let given = diagram(gauss)?;
    released(py, || code(&given.shortened(), components))
}

/// The prime summands of each piece.
#[pyfunction]
pub fn pieces(py: Python<'_>, gauss: Code, most: usize) -> PyResult<Vec<Vec<Code>>> {
    let given = diagram(gauss)?;
    let primes = |piece: exploring::Piece| piece.primes.into_iter().map(code_of_part).collect();
    released(py, || exploring::pieces(&given, most).into_iter().map(primes).collect())
}

/// Which of others moves make of a connected diagram.
#[pyfunction]
pub fn meeting(
    py: Python<'_>,
    gauss: Code,
    others: Vec<Code>,
    most: usize,
) -> PyResult<Option<usize>> {
    let given = diagram(gauss)?;
    let others: Vec<_> = others.into_iter().map(diagram).collect::<PyResult<_>>()?;
    released(py, || exploring::meeting(&given, &others, most))
}

/// The HOMFLY polynomial: powers of alpha and z, and coefficients.
#[pyfunction]
pub fn homfly(py: Python<'_>, gauss: Code, most: usize) -> PyResult<Option<Vec<(i32, i32, i64)>>> {
    let given = diagram(gauss)?;
    let found = released(py, || crate::diagrams::homfly::homfly(&given, most))?;
    Ok(found.map(|found| found.0.into_iter().map(|((a, z), value)| (a, z, value)).collect()))
}
