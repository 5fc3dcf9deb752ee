#pragma once

namespace igsp::cli {

/// From now on Ctrl-C and the other polite requests to end (SIGTERM, SIGHUP, SIGQUIT, SIGXCPU) only raise a flag, so
/// that no file is left half-written, and a file that grows beyond the limit of its size is an error of writing.
/// `then`, if given, is called from the signal handler too: it must be safe there.
void catch_interrupts(void (*then)() = nullptr);
bool interrupted();

/// 128 and the number of the signal, as shells have it; that of Ctrl-C if none came.
int interrupt_exit_code();

/// Throws Cancelled after an interrupt.
void stop_if_interrupted();

}  // namespace igsp::cli
