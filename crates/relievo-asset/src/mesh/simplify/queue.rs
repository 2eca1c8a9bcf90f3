//! A bucket queue of points, sorted by the cost of each point's best collapse. There are four buckets per octave of
//! squared costs. Inserting and removing take one step each. Costs in the same bucket count as equal, and are taken in
//! the order of insertion.

/// The best collapse of a point: the neighbour to merge into, and the cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Best {
    pub neighbor: u32,
    /// The squared cost; at least 0.
    pub cost: f32,
    /// The part of the squared cost that is known before distances are measured.
    pub base: f32,
    /// Whether the point has a cheaper collapse that is currently illegal.
    pub is_second: bool,
    /// Whether `cost` includes the measured distances. These stay valid until the point's triangles change.
    pub is_measured: bool,
}

/// Number of a cost's bits that choose its bucket: eight bits of the exponent and two of the mantissa.
const BITS: u32 = 10;
const BUCKETS: usize = 1 << BITS;
/// Number of points that [`Queue::ahead`] returns at once.
const AHEAD: usize = 16;
/// Marks a point that is in no bucket.
const NONE: u16 = u16::MAX;

/// The queued collapse of one point.
#[derive(Debug, Clone, Copy)]
struct State {
    neighbor: u32,
    cost: f32,
    base: f32,
    /// Bucket with the point's valid entry. Entries in other buckets are outdated, and are dropped when they are reached.
    bucket: u16,
    is_second: bool,
    is_measured: bool,
}

/// Queue of points, and the best collapse of each point.
pub(crate) struct Queue {
    states: Vec<State>,
    buckets: Vec<Vec<u32>>,
    /// Number of entries taken from each bucket.
    taken: Vec<u32>,
    /// One bit per bucket, set if the bucket may have entries.
    filled: [u64; BUCKETS / 64],
    /// Index in `filled` of the first word whose buckets may have entries.
    first: usize,
    /// Factor for squared costs. With it, meshes of the same shape get the same buckets at any size.
    unit: f32,
}

impl Queue {
    /// An empty queue for `points` points. `extent` is the size of the mesh, in the units of costs.
    pub(crate) fn new(points: usize, extent: f64) -> Self {
        let unit = if extent > 0.0 { (1.0 / (extent * extent)) as f32 } else { 1.0 };
        let state =
            State { neighbor: 0, cost: 0.0, base: 0.0, bucket: NONE, is_second: false, is_measured: false };
        let (buckets, taken) = (vec![Vec::new(); BUCKETS], vec![0; BUCKETS]);
        Self { states: vec![state; points], buckets, taken, filled: [0; BUCKETS / 64], first: 0, unit }
    }

    /// The neighbour of a point's best collapse, as last set.
    #[inline]
    pub(crate) fn neighbor(&self, point: u32) -> u32 {
        self.states[point as usize].neighbor
    }

    /// Replaces the best collapse of a point. `None` removes the point from the queue.
    #[inline]
    pub(crate) fn set(&mut self, point: u32, best: Option<Best>) {
        let Some(Best { neighbor, cost, base, is_second, is_measured }) = best else {
            self.states[point as usize].bucket = NONE;
            return;
        };
        let bucket = self.bucket_of(cost);
        let state = &mut self.states[point as usize];
        let is_there = state.bucket == bucket;
        *state = State { neighbor, cost, base, bucket, is_second, is_measured };
        if !is_there {
            self.put(point, bucket);
        }
    }

    fn put(&mut self, point: u32, bucket: u16) {
        self.buckets[bucket as usize].push(point);
        let word = bucket as usize / 64;
        self.filled[word] |= 1 << (bucket % 64);
        self.first = self.first.min(word);
    }

    /// The next few points of the current bucket, for prefetching. Empty except once every `AHEAD` points.
    #[inline]
    pub(crate) fn ahead(&self) -> &[u32] {
        let Some(word) = self.filled.get(self.first).filter(|word| **word != 0) else { return &[] };
        let bucket = self.first * 64 + word.trailing_zeros() as usize;
        let taken = self.taken[bucket] as usize;
        if !taken.is_multiple_of(AHEAD) {
            return &[];
        }
        let entries = &self.buckets[bucket];
        &entries[taken..entries.len().min(taken + AHEAD)]
    }

    /// Whether the collapse `best` belongs in a later bucket than the collapse `than`.
    #[inline]
    pub(crate) fn is_later(&self, best: &Best, than: &Best) -> bool {
        self.bucket_of(best.cost) > self.bucket_of(than.cost)
    }

    /// Removes the next point from the queue, and returns it with its best collapse.
    pub(crate) fn pop(&mut self) -> Option<(u32, Best)> {
        loop {
            while *self.filled.get(self.first)? == 0 {
                self.first += 1;
            }
            let word = self.first;
            let bucket = word * 64 + self.filled[word].trailing_zeros() as usize;
            let taken = self.taken[bucket] as usize;
            let Some(&point) = self.buckets[bucket].get(taken) else {
                self.buckets[bucket].clear();
                self.taken[bucket] = 0;
                self.filled[word] &= self.filled[word] - 1;
                continue;
            };
            self.taken[bucket] += 1;
            let state = &mut self.states[point as usize];
            if usize::from(state.bucket) != bucket {
                continue;
            }
            state.bucket = NONE;
            let State { neighbor, cost, base, is_second, is_measured, .. } = *state;
            return Some((point, Best { neighbor, cost, base, is_second, is_measured }));
        }
    }

    /// Bucket of a squared cost: the leading bits of the float. Non-negative floats and their bits have the same order.
    #[inline]
    fn bucket_of(&self, cost: f32) -> u16 {
        ((cost * self.unit).to_bits() >> (31 - BITS)) as u16
    }
}
