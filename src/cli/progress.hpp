#pragma once
/// \file

#include "verbs/study.hpp"

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

namespace percuss::cli {

/// Progress on stderr: a bar with the time left on a terminal, a line every few seconds elsewhere.
class Progress {
public:
    /// `quiet`: shows nothing.
    explicit Progress(bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// For studies; may be called from several threads. Must not outlive this object.
    verbs::Observer observer();

private:
    using Clock = std::chrono::steady_clock;

    void show(double share, std::string_view line);
    [[nodiscard]] std::string time_left(double share) const;

    bool quiet_;
    bool terminal_;
    bool bar_on_screen_ = false;
    Clock::time_point begun_ = Clock::now();
    Clock::time_point last_shown_ = begun_;
    std::mutex mutex_;
};

}  // namespace percuss::cli
