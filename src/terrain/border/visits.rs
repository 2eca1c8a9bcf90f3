//! The sequence of dispatches that moves the patches of a batch that lies in several buffers.

use std::collections::BTreeMap;

use super::{Neighbours, waves};
use crate::InputError;
use crate::shared::terrain::border::NONE;
use crate::terrain::fields::Place;

/// One dispatch: patches of one part that move towards neighbours that all lie in one part.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Visit {
    /// Index of the part that holds the patches.
    pub part: usize,
    /// Index of the part that holds their neighbours.
    pub source: usize,
    /// The index of each patch in its part, with the indices of its neighbours in theirs.
    pub entries: Vec<(u32, [u32; 4])>,
}

/// The dispatches in order, given where each patch lies. A patch whose neighbours all lie in its own part takes
/// one dispatch; any other takes one dispatch for each of its sides, in the order in which the kernel handles
/// sides.
///
/// # Errors
/// [`InputError`] as [`waves`].
pub(super) fn visits(neighbours: &[Neighbours], places: &[Place]) -> Result<Vec<Visit>, InputError> {
    let mut visits = Vec::new();
    for wave in waves(neighbours)? {
        let mut dispatches = BTreeMap::<_, Vec<_>>::new();
        for patch in wave {
            let Place { part, index } = places[patch as usize];
            let around = neighbours[patch as usize].map(|neighbour| neighbour.map(|at| places[at]));
            let mut visit = |turn: usize, source: usize, around: [Option<Place>; 4]| {
                let around = around.map(|place| place.map_or(NONE, |place| place.index));
                dispatches.entry((part, turn, source)).or_default().push((index, around));
            };
            if around.iter().flatten().all(|place| place.part == part) {
                visit(0, part, around);
                continue;
            }
            for (side, neighbour) in around.into_iter().enumerate() {
                let Some(place) = neighbour else { continue };
                let mut only = [None; 4];
                only[side] = neighbour;
                visit(side, place.part, only);
            }
        }
        let made = dispatches.into_iter();
        visits.extend(made.map(|((part, _, source), entries)| Visit { part, source, entries }));
    }
    Ok(visits)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(counts: &[u32]) -> Vec<Place> {
        let part = |(part, count): (usize, &u32)| (0..*count).map(move |index| Place { part, index });
        counts.iter().enumerate().flat_map(part).collect()
    }

    /// A patch with all four neighbours, which lie in different parts.
    fn surrounded() -> Vec<Neighbours> {
        vec![[None; 4], [None; 4], [None; 4], [None; 4], [Some(2), Some(0), Some(3), Some(1)]]
    }

    #[test]
    fn one_part_is_visited_wave_by_wave() {
        let visits = visits(&surrounded(), &places(&[5])).expect("in order");
        let first = (0..4).map(|index| (index, [NONE; 4])).collect();
        let expected = [
            Visit { part: 0, source: 0, entries: first },
            Visit { part: 0, source: 0, entries: vec![(4, [2, 0, 3, 1])] },
        ];
        assert_eq!(visits, expected);
    }

    #[test]
    fn sides_keep_their_order_across_parts() {
        let visits = visits(&surrounded(), &places(&[2, 3])).expect("in order");
        let last: Vec<_> = (visits.iter())
            .filter(|visit| visit.entries[0].1 != [NONE; 4])
            .map(|visit| (visit.part, visit.source, visit.entries.as_slice()))
            .collect();
        let expected: [(_, _, &[_]); 4] = [
            (1, 1, &[(2, [0, NONE, NONE, NONE])]),
            (1, 0, &[(2, [NONE, 0, NONE, NONE])]),
            (1, 1, &[(2, [NONE, NONE, 1, NONE])]),
            (1, 0, &[(2, [NONE, NONE, NONE, 1])]),
        ];
        assert_eq!(last, expected);
    }
}
