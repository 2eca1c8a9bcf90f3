// Which outputs a thread makes. The outputs of a window are cut into blocks, a thread makes one, and neighbouring threads make
// neighbouring blocks of a row or of a column.

// How the outputs of all windows are cut.
struct Blocks {
    // Blocks along a row of a window, and in a window.
    per_row: u32,
    per_window: u32,
    // Blocks in all windows.
    count: u32,
    // Rows of a block.
    rows: u32,
}

// A thread of a workgroup of 64.
struct Thread {
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
}

// What a thread makes.
struct Block {
    // Whether there is one for this thread.
    there: bool,
    window: u32,
    // Column and row among the window's blocks.
    at: vec2<u32>,
}

// The block of a thread where neighbouring threads make the blocks of a row.
fn block_of(blocks: Blocks, thread: Thread) -> Block {
    return block_in_line(blocks, thread, false);
}

// The block of a thread where neighbouring threads make the blocks of a row or, if `downwards`, of a column.
fn block_in_line(blocks: Blocks, thread: Thread, downwards: bool) -> Block {
    let index = (thread.group.y * thread.groups.x + thread.group.x) * 64u + thread.lane;
    let in_window = index % blocks.per_window;
    let line = select(blocks.per_row, blocks.per_window / blocks.per_row, downwards);
    let at = vec2<u32>(in_window % line, in_window / line);
    return Block(index < blocks.count, index / blocks.per_window, select(at, at.yx, downwards));
}

// A part of a row or column of blocks that does not cross from a rim into what lies inside it.
struct Span {
    start: u32,
    end: u32,
    // 0 before the inside, 1 inside, 2 behind it.
    tile: u32,
}

// The samples of block `block`, at most `width`, along an edge of `inside` samples with a rim of `rim` at both ends.
fn span_of(block: u32, width: u32, rim: u32, inside: u32) -> Span {
    let rim_blocks = (rim + width - 1u) / width;
    let inside_blocks = (inside + width - 1u) / width;
    let tile = u32(block >= rim_blocks) + u32(block >= rim_blocks + inside_blocks);
    let first = select(select(0u, rim_blocks, tile == 1u), rim_blocks + inside_blocks, tile == 2u);
    let begin = select(select(0u, rim, tile == 1u), rim + inside, tile == 2u);
    let length = select(rim, inside, tile == 1u);
    let start = (block - first) * width;
    return Span(begin + start, begin + min(start + width, length), tile);
}
