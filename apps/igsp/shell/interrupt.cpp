#include "shell/interrupt.hpp"

#include <csignal>

#include "igsp/errors.hpp"

namespace igsp::cli {
namespace {

volatile std::sig_atomic_t interrupt_flag = 0;  // a signal handler can reach nothing but a global

extern "C" void raise_interrupt_flag(int) {
  interrupt_flag = 1;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = raise_interrupt_flag;  // without SA_RESTART: a blocked read returns
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() {
  return interrupt_flag != 0;
}

void stop_if_interrupted() {
  if (interrupted()) throw Cancelled();
}

}  // namespace igsp::cli
