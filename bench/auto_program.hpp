#pragma once
/// \file
/// AUTO-07p as a program to be compiled, run and timed: an equations file and a constants file in a temporary folder.

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace percuss::bench {

/// A row of AUTO's bifurcation diagram (file fort.7), eleven digits each.
struct AutoRow {
    int type = 0;  ///< 5: limit point
    std::vector<double> columns;
};

struct AutoRun {
    bool ok = false;
    double solver_seconds = std::numeric_limits<double>::infinity();   ///< "Total Time" by AUTO's own clock
    double process_seconds = std::numeric_limits<double>::infinity();  ///< of the whole program, start included
    std::vector<AutoRow> rows;
};

class AutoProgram {
public:
    /// Where AUTO is: $AUTO_DIR, else where Debian puts it. Sets `missing` to one sentence when something is absent.
    static std::optional<std::filesystem::path> find(std::string& missing) {
        const char* given = std::getenv("AUTO_DIR");
        const std::filesystem::path folder = given != nullptr ? given : "/usr/lib/auto-07p";
        if (!std::filesystem::exists(folder / "lib" / "main.o")) {
            missing = "AUTO-07p not found in " + folder.string() + " (Debian package auto-07p, or set AUTO_DIR)";
            return std::nullopt;
        }
        if (std::system("gfortran --version > /dev/null 2>&1") != 0) {
            missing = "AUTO-07p needs gfortran, which was not found (Debian package gfortran)";
            return std::nullopt;
        }
        return folder;
    }

    /// Compiles NAME.f90 against AUTO and reads the constants c.NAME. Throws std::runtime_error when that fails.
    AutoProgram(const std::filesystem::path& auto_folder, const std::filesystem::path& sources,
                const std::string& name) {
        std::string pattern = (std::filesystem::temp_directory_path() / "percuss-auto-XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr) { throw std::runtime_error("no temporary folder for AUTO"); }
        folder_ = pattern;
        std::filesystem::copy_file(sources / (name + ".f90"), folder_ / (name + ".f90"));
        std::ifstream constants(sources / ("c." + name));
        constants_ = std::string(std::istreambuf_iterator<char>(constants), {});
        const std::string command = "cd '" + folder_.string() + "' && gfortran -O3 -march=native -fopenmp " + name +
                                    ".f90 '" + auto_folder.string() + "'/lib/*.o -o " + executable + " > log 2>&1";
        if (constants_.empty() || std::system(command.c_str()) != 0) {
            throw std::runtime_error("AUTO's program could not be built: see " + (folder_ / "log").string());
        }
    }
    AutoProgram(const AutoProgram&) = delete;
    AutoProgram& operator=(const AutoProgram&) = delete;
    ~AutoProgram() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }

    /// The constants file followed by `further` lines; threads 0: as many as AUTO takes by itself.
    [[nodiscard]] AutoRun run(const std::string& further, int threads = 1) const {
        std::ofstream(folder_ / "constants") << constants_ << further << '\n';
        if (threads > 0) {
            setenv("OMP_NUM_THREADS", std::to_string(threads).c_str(), 1);
        } else {
            unsetenv("OMP_NUM_THREADS");
        }
        AutoRun run;
        const auto start = std::chrono::steady_clock::now();
        if (!execute(folder_ / executable, {executable})) { return run; }
        run.process_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (const auto own = total_time()) {
            run.solver_seconds = *own;
            run.rows = diagram();
            run.ok = !run.rows.empty();
        }
        return run;
    }

    /// What another program writes to its standard output, run in the same way; empty when it fails.
    [[nodiscard]] std::optional<std::string> run_other(const std::string& program,
                                                       std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), program);
        if (!execute(std::filesystem::canonical(program), std::move(arguments))) { return std::nullopt; }
        std::ifstream screen(folder_ / "screen");
        return std::string(std::istreambuf_iterator<char>(screen), {});
    }

private:
    /// Runs a program in the folder, from the constants to the screen.
    [[nodiscard]] bool execute(const std::filesystem::path& program, std::vector<std::string> arguments) const {
        std::vector<char*> pointers;
        for (std::string& argument : arguments) { pointers.push_back(argument.data()); }
        pointers.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addchdir_np(&actions, folder_.c_str());
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "constants", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "screen", O_WRONLY | O_CREAT | O_TRUNC, 0600);
        pid_t child = 0;
        const bool spawned = posix_spawn(&child, program.c_str(), &actions, nullptr, pointers.data(), environ) == 0;
        posix_spawn_file_actions_destroy(&actions);
        int status = 0;
        return spawned && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }

    [[nodiscard]] std::optional<double> total_time() const {
        std::ifstream screen(folder_ / "screen");
        std::string word;
        while (screen >> word) {
            double seconds = 0.0;
            if (word == "Time" && screen >> seconds) { return seconds; }
        }
        return std::nullopt;
    }

    [[nodiscard]] std::vector<AutoRow> diagram() const {
        std::vector<AutoRow> rows;
        std::ifstream file(folder_ / "fort.7");
        for (std::string line; std::getline(file, line);) {
            std::istringstream words(line);
            int branch = 0;
            int point = 0;
            int label = 0;
            AutoRow row;
            if (!(words >> branch) || branch == 0 || !(words >> point >> row.type >> label)) { continue; }
            for (double value = 0.0; words >> value;) { row.columns.push_back(value); }
            row.type = row.type % 10;
            rows.push_back(std::move(row));
        }
        return rows;
    }

    static constexpr const char* executable = "program";
    std::filesystem::path folder_;
    std::string constants_;
};

}  // namespace percuss::bench
