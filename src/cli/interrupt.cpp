#include "cli/interrupt.hpp"

#include <csignal>

namespace percuss::cli {

namespace {

volatile std::sig_atomic_t signal_seen = 0;

extern "C" void remember_signal(int signal) {
    signal_seen = 1;
    std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_for_interrupts() {
    std::signal(SIGINT, remember_signal);
    std::signal(SIGTERM, remember_signal);
}

bool interrupted() { return signal_seen != 0; }

}  // namespace percuss::cli
