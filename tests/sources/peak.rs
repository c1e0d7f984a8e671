//! An allocator that knows the most memory that a thread has held.

#![expect(unsafe_code, reason = "an allocator cannot be written without")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static HELD: Cell<isize> = const { Cell::new(0) };
    static MOST: Cell<isize> = const { Cell::new(0) };
}

struct Watching;

fn note(more: isize) {
    // A thread that ends has no counter any more.
    let _ = HELD.try_with(|held| held.set(held.get() + more));
    let _ = MOST.try_with(|most| most.set(most.get().max(HELD.try_with(Cell::get).unwrap_or(0))));
}

// SAFETY: every call goes to the system's allocator unchanged; watching neither allocates nor unwinds.
unsafe impl GlobalAlloc for Watching {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        note(layout.size() as isize);
        // SAFETY: the caller keeps `alloc`'s contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        note(-(layout.size() as isize));
        // SAFETY: the caller keeps `dealloc`'s contract; the memory came from the system's allocator.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        note(size as isize - layout.size() as isize);
        // SAFETY: the caller keeps `realloc`'s contract; the memory came from the system's allocator.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Watching = Watching;

/// The most bytes that this thread holds at once within `f`, above what it held before; and what `f` gives.
pub(crate) fn most<T>(f: impl FnOnce() -> T) -> (usize, T) {
    let before = HELD.with(Cell::get);
    MOST.with(|most| most.set(before));
    let result = f();
    (MOST.with(|most| most.get() - before) as usize, result)
}
