//! Order of dispatches for the transitions of a batch that is split into several buffers (parts).

use std::collections::BTreeMap;

use super::{Neighbours, waves};
use crate::InputError;
use crate::terrain::fields::Place;

/// One dispatch. It moves samples of patches in the part `part` towards neighbours in the part `source`.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Visit {
    /// Index of the part that holds the patches to change.
    pub part: usize,
    /// Index of the part that holds the neighbours of these patches.
    pub source: usize,
    /// Index of each patch within `part`, and the indices of its four neighbours within `source`.
    pub entries: Vec<(u32, [Option<u32>; 4])>,
}

/// Dispatches in order, for patches at the given places. If all neighbours of a patch lie in the patch's own part, the patch
/// takes one dispatch. Otherwise it takes one dispatch per side, in the order in which the kernel handles the sides.
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
                let around = around.map(|place| place.map(|place| place.index));
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

    /// A patch with all four neighbours in different parts.
    fn surrounded() -> Vec<Neighbours> {
        vec![[None; 4], [None; 4], [None; 4], [None; 4], [Some(2), Some(0), Some(3), Some(1)]]
    }

    #[test]
    fn one_part_is_visited_wave_by_wave() {
        let visits = visits(&surrounded(), &places(&[5])).expect("in order");
        let first = (0..4).map(|index| (index, [None; 4])).collect();
        let expected = [
            Visit { part: 0, source: 0, entries: first },
            Visit { part: 0, source: 0, entries: vec![(4, [2, 0, 3, 1].map(Some))] },
        ];
        assert_eq!(visits, expected);
    }

    #[test]
    fn sides_keep_their_order_across_parts() {
        let visits = visits(&surrounded(), &places(&[2, 3])).expect("in order");
        let last: Vec<_> = (visits.iter())
            .filter(|visit| visit.entries[0].1 != [None; 4])
            .map(|visit| (visit.part, visit.source, visit.entries.as_slice()))
            .collect();
        let expected: [(_, _, &[_]); 4] = [
            (1, 1, &[(2, [Some(0), None, None, None])]),
            (1, 0, &[(2, [None, Some(0), None, None])]),
            (1, 1, &[(2, [None, None, Some(1), None])]),
            (1, 0, &[(2, [None, None, None, Some(1)])]),
        ];
        assert_eq!(last, expected);
    }
}
