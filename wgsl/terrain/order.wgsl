// The order of blocks where it depends on the device.
import package::wgsl::terrain::blocks::{Block, Blocks, Thread, block_in_line};

// Whether neighbouring threads make the blocks of a column, not of a row. Hardware joins the loads of threads that lie beside each
// other. A processor fetches the cache lines beside those that a column reads, and has them when it comes to the next column.
override DOWNWARDS: bool = false;

// The block of a thread.
fn block_in_order(blocks: Blocks, thread: Thread) -> Block {
    return block_in_line(blocks, thread, DOWNWARDS);
}
