#pragma once

namespace igsp::cli {

/// From now on Ctrl-C and SIGTERM only raise a flag, so that no file is left half-written.
void catch_interrupts();
bool interrupted();

/// Throws Cancelled after an interrupt.
void stop_if_interrupted();

}  // namespace igsp::cli
