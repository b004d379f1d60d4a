#include "cli/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <unistd.h>

namespace percuss::cli {

namespace {

using namespace std::chrono_literals;

constexpr int bar_width = 30;
constexpr auto between_bars = 100ms;
constexpr auto between_lines = 5s;
constexpr double too_early = 0.01;  // share below which no end is foretold

}  // namespace

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
    if (bar_on_screen_) { std::fputs("\r\033[K", stderr); }
}

verbs::Observer Progress::observer() {
    return [this](double share, std::string_view line) { show(share, line); };
}

void Progress::show(double share, std::string_view line) {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    const auto pause = terminal_ ? Clock::duration(between_bars) : Clock::duration(between_lines);
    if (quiet_ || now - last_shown_ < pause) { return; }
    last_shown_ = now;
    const std::string text(line);
    const double known = std::clamp(share, 0.0, 1.0);
    if (terminal_) {
        const int full = static_cast<int>(std::lround(known * bar_width));
        const std::string bar = std::string(static_cast<std::size_t>(full), '#') +
                                std::string(static_cast<std::size_t>(bar_width - full), '.');
        std::fprintf(stderr, "\r\033[K[%s] %3.0f %%%s  %.60s", bar.c_str(), 100.0 * known, time_left(share).c_str(),
                     text.c_str());
        bar_on_screen_ = true;
    } else {
        std::fprintf(stderr, "percuss: %3.0f %%%s  %s\n", 100.0 * known, time_left(share).c_str(), text.c_str());
    }
    std::fflush(stderr);
}

std::string Progress::time_left(double share) const {
    if (!(share > too_early && share <= 1.0)) { return ""; }
    const double spent = std::chrono::duration<double>(Clock::now() - begun_).count();
    return ", " + std::to_string(std::lround(spent * (1.0 - share) / share)) + " s left";
}

}  // namespace percuss::cli
