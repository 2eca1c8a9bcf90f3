//! Hydraulic erosion: the CPU reference of `kernels/terrain/hydraulic.wgsl`.

use crate::shared::terrain::fixed::HEIGHT_LIMIT;
use crate::shared::terrain::hydraulic::{HydraulicParams, SEDIMENT_LIMIT, WATER_LIMIT};

/// Water state of a sample. Words 0 and 1 are water and suspended sediment, in 1/65536 height units. Words 2 and 3 are the
/// fractions of water and sediment that leave through each side in the next cycle, in 1/32768. Word 2 has west in its low half
/// and east in its high half; word 3 has north and south.
pub type Flow = [i32; 4];

/// State of a sample. `shares` are the fractions of water and sediment that leave to the west, east, north and south, in 1/32768.
#[derive(Debug, Clone, Copy)]
struct Cell {
    ground: i32,
    water: i32,
    sediment: i32,
    shares: [i32; 4],
}

/// Computes one cycle on a window with [`HydraulicParams::in_width`] samples per row. Returns ground and flow without the
/// outermost ring of samples. If all heights are at most 2^30 − 1 in size, the new heights stay within this limit.
pub fn hydraulic(ground: &[i32], flow: &[Flow], params: &HydraulicParams) -> (Vec<i32>, Vec<Flow>) {
    let width = params.in_width as usize;
    let inner = (width - 2) * (width - 2);
    let (mut new_ground, mut new_flow) = (Vec::with_capacity(inner), Vec::with_capacity(inner));
    let cell = |at: usize| Cell::new(ground[at], if params.wet == 0 { [0; 4] } else { flow[at] });
    for y in 1..width - 1 {
        for at in y * width + 1..(y + 1) * width - 1 {
            let around = [cell(at - 1), cell(at + 1), cell(at - width), cell(at + width)];
            let (height, flow) = cycle(cell(at), around, params);
            new_ground.push(height + flow[1] * params.settles);
            new_flow.push(flow);
        }
    }
    (new_ground, new_flow)
}

impl Cell {
    #[inline(always)]
    fn new(ground: i32, [water, sediment, across, along]: Flow) -> Self {
        Self { ground, water, sediment, shares: [across & 0xffff, across >> 16, along & 0xffff, along >> 16] }
    }

    /// Height of the water's surface, clamped to the height limit.
    #[inline(always)]
    fn surface(self) -> i32 {
        (self.ground + self.water).min(HEIGHT_LIMIT)
    }

    /// Largest amount of water that one neighbour may add in this cycle.
    #[inline(always)]
    fn water_room(self) -> i32 {
        (WATER_LIMIT - self.water) >> 2
    }

    /// Largest amount of ground that one neighbour may add in this cycle. The same limit applies to added sediment.
    #[inline(always)]
    fn ground_room(self) -> i32 {
        (HEIGHT_LIMIT - self.ground - self.sediment) >> 3
    }

    /// Largest amount of sediment that one neighbour may add in this cycle.
    #[inline(always)]
    fn sediment_room(self) -> i32 {
        ((SEDIMENT_LIMIT - self.sediment) >> 2).min(self.ground_room())
    }

    /// Water and sediment that flow out to a neighbour through one side.
    #[inline(always)]
    fn leaving(self, side: usize, neighbour: Self) -> [i32; 2] {
        let share = self.shares[side];
        let water = part(self.water, share).min(neighbour.water_room());
        [water, part(self.sediment, share).min(neighbour.sediment_room())]
    }

    /// Amount of ground that slides and creeps down to a neighbour.
    #[inline(always)]
    fn sliding(self, neighbour: Self, params: &HydraulicParams) -> i32 {
        let step = (self.ground - neighbour.ground).max(0);
        let slid = (step - params.talus).max(0) >> 3;
        (slid + part(step, params.creep)).min(neighbour.ground_room())
    }
}

/// Computes one cycle of one sample; `around` are the neighbours to the west, east, north and south. Returns the new ground and
/// flow.
#[inline(always)]
fn cycle(cell: Cell, around: [Cell; 4], params: &HydraulicParams) -> (i32, Flow) {
    let (mut lost, mut gained, mut slid) = ([0; 2], [0; 2], 0);
    for (side, neighbour) in around.into_iter().enumerate() {
        let out = cell.leaving(side, neighbour);
        let into = neighbour.leaving(side ^ 1, cell);
        for what in 0..2 {
            lost[what] += out[what];
            gained[what] += into[what];
        }
        slid += neighbour.sliding(cell, params) - cell.sliding(neighbour, params);
    }
    let moved = cell.water - lost[0] + gained[0];
    let sediment = cell.sediment - lost[1] + gained[1];
    let falls = around.map(|neighbour| cell.surface() - neighbour.surface());
    let carried = capacity(discharge((lost[0] + gained[0]) >> 1, around), falls, params);
    let steps = around.map(|neighbour| cell.ground - neighbour.ground);
    let lifted = lifted(steps, moved, carried - sediment, params);
    let water = (moved - part(moved, params.evaporation) + params.rain).min(WATER_LIMIT);
    let [west, east, north, south] = next_shares(cell, falls, water, params);
    (cell.ground - lifted + slid, [water, sediment + lifted, west | east << 16, north | south << 16])
}

/// Discharge at a sample: a quarter of the sample's own discharge plus three quarters of the mean outflow of its neighbours. The
/// average makes streams wider than one sample, and independent of the grid's directions.
#[inline(always)]
fn discharge(own: i32, around: [Cell; 4]) -> i32 {
    let leaving = |cell: Cell| part(cell.water, cell.shares.into_iter().sum()) >> 3;
    let eighths: i32 = around.into_iter().map(leaving).sum();
    (own >> 2) + eighths + (eighths >> 1)
}

/// Sediment that water can carry at a given discharge. `falls` are the differences between the water surfaces of the sample and
/// its four neighbours. The slope is approximated from its two components: the larger one plus three eighths of the smaller one.
#[inline(always)]
fn capacity(discharge: i32, falls: [i32; 4], params: &HydraulicParams) -> i32 {
    let [across, along] = [falls[0].max(falls[1]), falls[2].max(falls[3])]
        .map(|fall| ((fall.clamp(0, params.steepest) >> params.slope_shift) * params.slope_factor) >> 15);
    let slope = across.max(along) + ((across.min(along) * 3) >> 3);
    let rate = ((slope * params.capacity) >> 8).min(1 << 18);
    let driving = (discharge - params.threshold).clamp(0, WATER_LIMIT);
    let high = driving >> 12;
    // A larger rate would give more than `SEDIMENT_LIMIT` in any case, and its product with `high` could overflow.
    let safe = rate.min(1 << (high.max(1).leading_zeros() - 2));
    (high * safe + (((driving & 4095) * rate) >> 12)).min(SEDIMENT_LIMIT)
}

/// Ground that goes into suspension; negative if sediment settles. Ground does not sink below its lowest neighbour. Deposits do
/// not rise above the highest neighbour or the water.
#[inline(always)]
fn lifted(steps: [i32; 4], water: i32, lacking: i32, params: &HydraulicParams) -> i32 {
    if lacking > 0 {
        let deepest = steps.into_iter().fold(0, i32::max);
        return part(lacking, params.erosion).min(deepest >> 3);
    }
    let highest = steps.into_iter().fold(0, |highest, step| highest.max(-step));
    -part(-lacking, params.deposition).min((highest >> 3).max(water >> 2))
}

/// Fractions of water and sediment that leave through each side in the next cycle. Each virtual pipe keeps half of its flux and
/// gains a sixteenth of the fall of the water surface. In addition, 1/32 of the water, at most the threshold, spreads through
/// each pipe, so that streams do not align with rows and columns. At most three quarters of the water leave through all pipes
/// together. If more water left, neighbours could exchange all of their water in every cycle.
#[inline(always)]
fn next_shares(cell: Cell, falls: [i32; 4], water: i32, params: &HydraulicParams) -> [i32; 4] {
    let spread = (water >> 5).min(params.threshold);
    let mut flux = [0; 4];
    for side in 0..4 {
        let old = part(cell.water, cell.shares[side]);
        flux[side] = (old - (old >> 1) + (falls[side] >> 4) + spread).clamp(0, WATER_LIMIT);
    }
    let whole = flux.into_iter().sum::<i32>().max(water).max(1) as u32;
    let shift = 16 - whole.leading_zeros().min(16);
    let inverse = (1 << 31) / (whole >> shift);
    flux.map(|flux| ((((flux as u32 >> shift) * inverse) >> 16) as i32 * 3) >> 2)
}

/// Returns ⌊amount · share / 32768⌋ without overflow. Valid for amounts of 0 to 2^30 with shares of 0 to 32768, and for any
/// amount with shares of at most 2048.
#[inline(always)]
fn part(amount: i32, share: i32) -> i32 {
    (amount >> 15) * share + (((amount & 32767) * share) >> 15)
}
