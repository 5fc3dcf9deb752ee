#include "shell/interrupt.hpp"

#include <csignal>

#include "igsp/errors.hpp"

namespace igsp::cli {
namespace {

// A signal handler can reach nothing but globals.
volatile std::sig_atomic_t interrupt_signal = 0;
void (*after_interrupt)() = nullptr;

extern "C" void note_interrupt(int number) {
  if (interrupt_signal == 0) interrupt_signal = number;
  if (after_interrupt) after_interrupt();
}

bool is_ignored(int number) {
  struct sigaction action {};
  return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void catch_interrupts(void (*then)()) {
  after_interrupt = then;
  struct sigaction action {};
  action.sa_handler = note_interrupt;  // without SA_RESTART: a blocked read returns
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU}) {
    if (number == SIGHUP && is_ignored(number)) continue;  // nohup
    sigaction(number, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() {
  return interrupt_signal != 0;
}

int interrupt_exit_code() {
  constexpr int killed_by = 128;
  return killed_by + (interrupted() ? static_cast<int>(interrupt_signal) : SIGINT);
}

void stop_if_interrupted() {
  if (interrupted()) throw Cancelled();
}

}  // namespace igsp::cli
