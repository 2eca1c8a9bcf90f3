// A budget of triangles: by how much the levels of the objects that share it are coarsened.
struct BudgetState {
    // Factors of the metric by rank, 1 or more, and from `NO_RANK` on 1.
    factors: array<vec4<f32>, 3>,
    // 1 if all fades end in this frame, because both levels of each would not fit.
    ends_fades: u32,
    // 1 if even the coarsest levels do not fit.
    is_missed: u32,
    // Number of triangles that are drawn, in units of the budget, both levels of a fade included.
    triangles: u32,
    // How far the objects are coarsened, in steps of the histogram: rank by rank, and within a rank by the logarithm of the
    // factor.
    pressure: u32,
}
