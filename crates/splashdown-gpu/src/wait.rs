//! Runs futures to completion.

use std::future::Future;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

/// Runs a future to completion.
///
/// Outside a web page a future of this project waits for the device whenever it is polled, so this is equivalent to a
/// blocking function.
///
/// # Panics
/// On a web page, which cannot block, if the future has to wait for the browser. Work on the CPU never waits.
pub fn block_on<T>(future: impl Future<Output = T>) -> T {
    if cfg!(not(target_arch = "wasm32")) {
        return pollster::block_on(future);
    }
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(value) => value,
        Poll::Pending => panic!("a web page cannot block: await the asynchronous form of this function"),
    }
}
