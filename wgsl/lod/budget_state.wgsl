// State of a triangle budget: how much the budget coarsens the levels of detail of its objects.
struct BudgetState {
    // Factor per rank, 1 or more. It multiplies the metric by which levels are chosen. Elements from `NO_RANK` on are 1.
    factors: array<vec4<f32>, 3>,
    // 1 if all fades end in this frame, because the budget cannot hold both levels of every fade; else 0.
    ends_fades: u32,
    // 1 if even the coarsest levels exceed the budget, else 0.
    is_missed: u32,
    // Number of triangles drawn, in units of the budget. An instance that fades counts with both levels.
    triangles: u32,
    // Degree of coarsening: an integer position on a scale. The scale has one section per rank, in the order of ranks. Within a
    // section, the position is proportional to the logarithm of the rank's factor.
    pressure: u32,
}
