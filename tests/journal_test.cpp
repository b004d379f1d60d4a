// The journal of long runs: what it keeps, what it refuses, and that a kill at any moment loses no finished block.

#include "results/journal.hpp"
#include "results/merge.hpp"
#include "scratch_folder.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace percuss::results;
using percuss::tests::read_file;
using percuss::tests::ScratchFolder;
namespace fs = std::filesystem;

namespace {

const JournalWork work{
    "explore",
    "[stop]\ngap = 0.6 mm\n",
    {{"stop.gap", "m", false}, {"peak_force", "N", false}, {"status", "", true}, {"cause", "", true}}};

/// Numbers of every sort, a function of their place.
Row row_at(std::int64_t row) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double odd[] = {
        0.1 * static_cast<double>(row), nan,  -0.0, 0.0, std::numeric_limits<double>::infinity(), 5e-324,
        static_cast<double>(row),       1e300};
    return {odd[row % 8], std::sin(static_cast<double>(row)), std::string(row % 3 == 0 ? "failed" : "ok"),
            row % 3 == 0 ? "no orbit, \"row\"\n" + std::to_string(row) : std::string()};
}

RowBlock block_at(std::int64_t number, std::int64_t rows) {
    RowBlock block{number, {}};
    for (std::int64_t i = 0; i < rows_in_block(number, rows); ++i) {
        block.rows.push_back(row_at(number * rows_per_block + i));
    }
    return block;
}

/// All that a journal holds, with numbers as bits.
std::string dump(const Journal& journal) {
    std::string text;
    journal.for_each_block([&](const RowBlock& block) {
        text += "block " + std::to_string(block.number) + "\n";
        for (const Row& row : block.rows) {
            for (const Cell& cell : row) {
                const auto* number = std::get_if<double>(&cell);
                text += number == nullptr   ? std::get<std::string>(cell)
                      : std::isnan(*number) ? "none"
                                            : std::to_string(std::bit_cast<std::uint64_t>(*number));
                text += ',';
            }
            text += '\n';
        }
    });
    return text;
}

void fill(Journal& journal, std::int64_t rows) {
    journal.set_rows_wanted(rows);
    for (const std::int64_t block : journal.missing_blocks(rows)) { journal.write(block_at(block, rows)); }
}

void make(const fs::path& file, std::int64_t rows, const Shard& shard = {}) {
    Journal journal(file, work, shard);
    fill(journal, rows);
}

/// The fault, and that the message is one that helps and the file the same as before. `open` is expected to throw.
template <class Open>
JournalFault fault_of(const fs::path& file, const Open& open, std::string* message = nullptr) {
    const std::string before = fs::is_regular_file(file) ? read_file(file) : "";
    try {
        open();
    } catch (const JournalError& error) {
        const std::string text = error.what();
        CHECK(text.find(file.string()) != std::string::npos);
        CHECK(text.find(';') != std::string::npos);  // what is wrong; what to do
        if (error.fault() != JournalFault::other_work) { CHECK(text.find('\n') == std::string::npos); }
        if (fs::is_regular_file(file)) { CHECK(read_file(file) == before); }
        if (message != nullptr) { *message = text; }
        return error.fault();
    }
    FAIL("no JournalError");
    return JournalFault::foreign;
}

void overwrite(const fs::path& file, std::streamoff place, const std::string& bytes) {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(place);
    stream << bytes;
}

/// Runs `child` in a process of its own.
template <class Child>
pid_t start(const Child& child) {
    const pid_t id = fork();
    REQUIRE(id >= 0);
    if (id == 0) {
        try {
            child();
        } catch (...) { _exit(2); }
        _exit(0);
    }
    return id;
}

}  // namespace

TEST_CASE("what is written comes back bit by bit, in block order, from a file that stands alone") {
    const ScratchFolder folder;
    const fs::path file = folder.path() / "journal.sqlite";
    {
        Journal journal(file, work);
        CHECK(journal.blocks().empty());
        CHECK(journal.missing_blocks(200) == std::vector<std::int64_t>{0, 1, 2, 3});
        for (const std::int64_t block : {3, 0, 2, 1}) { journal.write(block_at(block, 200)); }
        journal.set_rows_wanted(200);
        CHECK(journal.missing_blocks(200).empty());
    }
    CHECK(fs::exists(file));
    CHECK_FALSE(fs::exists(file.string() + "-wal"));

    const Journal journal(file);
    CHECK(journal.work().kind == work.kind);
    CHECK(journal.work().problem == work.problem);
    CHECK(journal.work().columns == work.columns);
    CHECK(journal.rows_wanted() == 200);
    std::int64_t row = 0;
    journal.for_each_block([&](const RowBlock& block) {
        CHECK(block.number * rows_per_block == row);
        for (const Row& cells : block.rows) {
            const Row expected = row_at(row++);
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const auto* number = std::get_if<double>(&expected[i]);
                if (number == nullptr) {
                    CHECK(cells[i] == expected[i]);
                } else if (std::isnan(*number)) {
                    CHECK(std::isnan(std::get<double>(cells[i])));
                } else {
                    CHECK(std::bit_cast<std::uint64_t>(std::get<double>(cells[i])) ==
                          std::bit_cast<std::uint64_t>(*number));
                }
            }
        }
    });
    CHECK(row == 200);
    CHECK_THROWS_AS(static_cast<void>(journal.read(4)), std::out_of_range);
}

TEST_CASE("a table can be extended: the short last block is replaced by the whole one") {
    const ScratchFolder folder;
    const fs::path file = folder.path() / "journal.sqlite";
    make(file, 100);
    {
        Journal journal(file, work);
        CHECK(journal.missing_blocks(100).empty());
        CHECK(journal.missing_blocks(101) == std::vector<std::int64_t>{1});
        CHECK(journal.missing_blocks(300) == std::vector<std::int64_t>{1, 2, 3, 4});
        fill(journal, 300);
    }
    make(folder.path() / "fresh.sqlite", 300);
    CHECK(dump(Journal(file)) == dump(Journal(folder.path() / "fresh.sqlite")));
}

TEST_CASE("misuse is refused and leaves nothing behind") {
    const ScratchFolder folder;
    Journal journal(folder.path() / "journal.sqlite", work, Shard{1, 3});
    CHECK(journal.missing_blocks(640) == std::vector<std::int64_t>{1, 4, 7});
    CHECK_THROWS_AS(journal.write(block_at(0, 640)), std::invalid_argument);  // of another shard
    CHECK_THROWS_AS(journal.write({-2, {row_at(0)}}), std::invalid_argument);
    CHECK_THROWS_AS(journal.write({1, {}}), std::invalid_argument);
    CHECK_THROWS_AS(journal.write({1, {{1.0}}}), std::invalid_argument);  // too narrow
    CHECK_THROWS_AS(journal.write({1, {{1.0, 2.0, 3.0, std::string()}}}), std::invalid_argument);
    CHECK_THROWS_AS(journal.write({1, std::vector<Row>(65, row_at(0))}), std::invalid_argument);
    journal.write(block_at(1, 640));
    CHECK_THROWS_AS(journal.write(block_at(1, 640)), std::invalid_argument);  // already there
    CHECK_THROWS_AS(journal.set_rows_wanted(-1), std::invalid_argument);
    CHECK(journal.blocks().size() == 1);
}

TEST_CASE("another problem, verb, choice of columns or shard: both texts") {
    const ScratchFolder folder;
    const fs::path file = folder.path() / "journal.sqlite";
    make(file, 100);
    std::string message;

    JournalWork other = work;
    other.problem = "[stop]\ngap = 0.7 mm\n";
    CHECK(fault_of(
              file, [&] { Journal(file, other); }, &message) == JournalFault::other_work);
    CHECK(message.find("another problem") != std::string::npos);
    CHECK(message.find("gap = 0.6 mm") != std::string::npos);
    CHECK(message.find("gap = 0.7 mm") != std::string::npos);

    other = work;
    other.kind = "pareto";
    CHECK(fault_of(file, [&] { Journal(file, other); }) == JournalFault::other_work);
    other = work;
    other.columns[1].unit = "kN";
    CHECK(fault_of(
              file, [&] { Journal(file, other); }, &message) == JournalFault::other_work);
    CHECK(message.find("peak_force [kN]") != std::string::npos);
    CHECK(fault_of(
              file,
              [&] {
                  Journal(file, work, {0, 2});
              },
              &message) == JournalFault::other_work);
    CHECK(message.find("0/2") != std::string::npos);
    CHECK(Journal(file, work).blocks().size() == 2);
}

TEST_CASE("files that are something else are refused and not touched") {
    const ScratchFolder folder;
    const auto refused = [&](const fs::path& file) {
        const JournalFault writing = fault_of(file, [&] { Journal(file, work); });
        CHECK(fault_of(file, [&] { Journal{file}; }) == writing);
        return writing;
    };
    CHECK(refused(folder.write("text.sqlite", "not a database\n")) == JournalFault::foreign);
    CHECK(refused(folder.write("long.sqlite", std::string(100000, 'x'))) == JournalFault::foreign);
    CHECK(refused(folder.write("short.sqlite", "SQLite format 3")) == JournalFault::foreign);
    fs::create_directory(folder.path() / "folder.sqlite");
    CHECK(refused(folder.path() / "folder.sqlite") == JournalFault::foreign);

    // A database of another program: ours with another application id.
    const fs::path foreign = folder.path() / "foreign.sqlite";
    make(foreign, 100);
    overwrite(foreign, 68, "abcd");
    CHECK(refused(foreign) == JournalFault::foreign);
    const fs::path newer = folder.path() / "newer.sqlite";
    make(newer, 100);
    overwrite(newer, 63, "\x07");
    CHECK(refused(newer) == JournalFault::version);

    const fs::path absent = folder.path() / "absent.sqlite";
    CHECK(fault_of(absent, [&] { Journal{absent}; }) == JournalFault::no_access);
    CHECK_FALSE(fs::exists(absent));
    const fs::path nowhere = folder.path() / "nowhere" / "journal.sqlite";
    CHECK(fault_of(nowhere, [&] { Journal(nowhere, work); }) == JournalFault::no_access);

    // An empty file is a journal that was killed while it was begun.
    CHECK(Journal(folder.write("empty.sqlite", ""), work).blocks().empty());
}

TEST_CASE("damage anywhere in the file is found when it is opened, and the file left as it is") {
    const ScratchFolder folder;
    const fs::path good = folder.path() / "good.sqlite";
    make(good, 2000);
    const std::string whole = read_file(good);
    const std::string content = dump(Journal(good));
    const fs::path bad = folder.path() / "bad.sqlite";

    // A changed number within a row: only the digest tells. Row 1 holds sin(1).
    const auto bits = std::bit_cast<std::uint64_t>(std::sin(1.0));
    std::string stored;
    for (int i = 7; i >= 0; --i) { stored += static_cast<char>((bits >> (8 * i)) & 0xff); }
    const std::size_t place = whole.find(stored);
    REQUIRE(place != std::string::npos);
    fs::copy_file(good, bad);
    overwrite(bad, static_cast<std::streamoff>(place) + 5, "\x55");
    std::string message;
    CHECK(fault_of(
              bad, [&] { Journal(bad, work); }, &message) == JournalFault::corrupted);
    CHECK(message.find("block 0 does not match its digest") != std::string::npos);

    // Cut short.
    for (const double part : {0.1, 0.5, 0.9}) {
        percuss::tests::ScratchFolder own;
        const fs::path cut = own.write(
            "cut.sqlite", whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
        CHECK(fault_of(cut, [&] { Journal(cut, work); }) == JournalFault::corrupted);
    }

    // Random bytes over random places: refused, or (in unused space) harmless; never other rows.
    std::mt19937_64 random(1);
    int refusals = 0;
    for (int trial = 0; trial < 60; ++trial) {
        std::string text = whole;
        const std::size_t start_at = 100 + random() % (text.size() - 200);
        for (std::size_t i = start_at; i < start_at + 1 + trial % 40; ++i) { text[i] = static_cast<char>(random()); }
        const fs::path file = folder.write("hit.sqlite", text);
        try {
            const Journal journal(file, work);
            CHECK(dump(journal) == content);
        } catch (const JournalError& error) {
            ++refusals;
            CHECK(read_file(file) == text);
            const bool is_expected =
                error.fault() == JournalFault::corrupted || error.fault() == JournalFault::other_work;
            CHECK(is_expected);
        }
    }
    CHECK(refusals > 40);
}

TEST_CASE("a second writer is refused, in another process and in this one") {
    const ScratchFolder folder;
    const fs::path file = folder.path() / "journal.sqlite";
    int pipes[2];
    REQUIRE(pipe(pipes) == 0);
    const pid_t child = start([&] {
        Journal journal(file, work);
        journal.write(block_at(0, 640));
        if (write(pipes[1], "x", 1) != 1) { _exit(3); }
        for (;;) { pause(); }
    });
    close(pipes[1]);
    char ready = 0;
    REQUIRE(read(pipes[0], &ready, 1) == 1);
    CHECK(fault_of(file, [&] { Journal(file, work); }) == JournalFault::in_use);
    CHECK(fault_of(file, [&] { Journal{file}; }) == JournalFault::in_use);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);

    // What the killed one had written is there, and the lock has gone with it.
    Journal journal(file, work);
    CHECK(journal.blocks().size() == 1);
    journal.write(block_at(1, 640));
    CHECK(fault_of(file, [&] { Journal(file, work); }) == JournalFault::in_use);
    journal.write(block_at(2, 640));
    close(pipes[0]);
}

TEST_CASE("killed at random moments and resumed: the same as uninterrupted") {
    const ScratchFolder folder;
    const std::int64_t rows = 20000;
    make(folder.path() / "whole.sqlite", rows);
    const std::string whole = dump(Journal(folder.path() / "whole.sqlite"));

    std::mt19937_64 random(7);
    int killed_in_between = 0;
    for (int run = 0; run < 4; ++run) {
        const fs::path file = folder.path() / ("killed" + std::to_string(run) + ".sqlite");
        std::size_t before = 0;
        for (int attempt = 0; attempt < 40; ++attempt) {
            const pid_t child = start([&] {
                Journal journal(file, work);
                journal.set_rows_wanted(rows);
                for (const std::int64_t block : journal.missing_blocks(rows)) {
                    std::this_thread::sleep_for(std::chrono::microseconds(50));
                    journal.write(block_at(block, rows));
                }
            });
            // From the first instants, when the file is begun, to the middle of the blocks.
            std::this_thread::sleep_for(std::chrono::microseconds(random() % (attempt < 10 ? 5000 : 30000)));
            kill(child, SIGKILL);
            int status = 0;
            waitpid(child, &status, 0);
            if (!WIFSIGNALED(status)) {
                CHECK(WEXITSTATUS(status) == 0);
                break;
            }
            if (attempt % 8 == 7 && fs::exists(file)) {
                // Whole blocks only, and none of the earlier ones gone.
                const Journal journal(file, work);
                for (const auto& [block, count] : journal.blocks()) { CHECK(count == rows_in_block(block, rows)); }
                CHECK(journal.blocks().size() >= before);
                before = journal.blocks().size();
                if (before > 0 && before < 313) { ++killed_in_between; }
            }
        }
        make(file, rows);
        CHECK(dump(Journal(file)) == whole);
    }
    CHECK(killed_in_between > 4);  // else the kills came too early or too late to show anything
}

TEST_CASE("merged shards are the table that one process writes") {
    const ScratchFolder folder;
    const std::int64_t rows = 1000;  // 16 blocks, the last with 40 rows
    make(folder.path() / "whole.sqlite", rows);
    const std::string whole = dump(Journal(folder.path() / "whole.sqlite"));
    std::vector<fs::path> shards;
    for (std::int64_t i = 0; i < 3; ++i) {
        shards.push_back(folder.path() / ("shard" + std::to_string(i) + ".sqlite"));
        make(shards.back(), rows, {i, 3});
    }

    const fs::path target = folder.path() / "merged.sqlite";
    const MergeReport report = merge_journals({shards[2], shards[0], shards[1]}, target);
    CHECK(report.is_complete());
    CHECK(report.rows == rows);
    CHECK(report.overlaps == 0);
    CHECK(report.lacking.empty());
    CHECK(dump(Journal(target)) == whole);
    CHECK(Journal(target).shard().is_whole());
    CHECK(Journal(target).rows_wanted() == rows);

    // Again into the same target: every block comes twice, nothing changes.
    CHECK(merge_journals(shards, target).overlaps == 16);
    CHECK(dump(Journal(target)) == whole);
    // Merged journals may themselves be merged, and resumed as the whole table.
    CHECK(merge_journals({target, shards[0]}, folder.path() / "again.sqlite").overlaps == 6);
    CHECK(Journal(target, work).missing_blocks(rows).empty());
}

TEST_CASE("merging reports what is missing, takes the longer block, refuses what disagrees") {
    const ScratchFolder folder;
    const fs::path even = folder.path() / "even.sqlite";
    const fs::path odd = folder.path() / "odd.sqlite";
    make(even, 1000, {0, 2});
    {
        Journal journal(odd, work, {1, 2});
        journal.set_rows_wanted(1000);
        for (const std::int64_t block : {1, 9, 11}) { journal.write(block_at(block, 1000)); }
    }
    const MergeReport report = merge_journals({even, odd}, folder.path() / "merged.sqlite");
    CHECK_FALSE(report.is_complete());
    CHECK(report.missing == std::vector<BlockRange>{{3, 3}, {5, 5}, {7, 7}, {13, 13}, {15, 15}});
    REQUIRE(report.lacking.size() == 1);
    CHECK(report.lacking[0].find("odd.sqlite (shard 1/2): 5 blocks") != std::string::npos);
    CHECK(report.rows == 11 * 64);
    // Only one of two shards given: the blocks of the other are missing though no source lacks any.
    const MergeReport half = merge_journals({even}, folder.path() / "half.sqlite");
    CHECK(half.lacking.empty());
    CHECK(half.missing.size() == 8);

    // Two runs of different length: the longer last block wins, in either order.
    const fs::path brief = folder.path() / "brief.sqlite";
    const fs::path longer = folder.path() / "longer.sqlite";
    make(brief, 100);
    make(longer, 300);
    for (const auto& sources : {std::vector<fs::path>{brief, longer}, std::vector<fs::path>{longer, brief}}) {
        const fs::path target = folder.path() / ("both" + sources[0].stem().string() + ".sqlite");
        CHECK(merge_journals(sources, target).is_complete());
        CHECK(dump(Journal(target)) == dump(Journal(longer)));
    }

    const fs::path deviant = folder.path() / "deviant.sqlite";
    {
        Journal journal(deviant, work);
        RowBlock block = block_at(1, 300);
        block.rows[5][1] = 0.5;
        journal.write(block);
    }
    std::string message;
    CHECK(fault_of(
              deviant,
              [&] {
                  merge_journals({longer, deviant}, folder.path() / "x.sqlite");
              },
              &message) == JournalFault::conflict);
    CHECK(message.find("block 1") != std::string::npos);

    JournalWork other = work;
    other.problem = "another problem";
    const fs::path stranger = folder.path() / "stranger.sqlite";
    { Journal(stranger, other).write(block_at(0, 64)); }
    CHECK(fault_of(
              stranger,
              [&] {
                  merge_journals({longer, stranger}, folder.path() / "y.sqlite");
              },
              &message) == JournalFault::other_work);
    CHECK(message.find("another problem") != std::string::npos);
    CHECK(message.find("gap = 0.6 mm") != std::string::npos);

    CHECK_THROWS_AS(merge_journals({}, folder.path() / "z.sqlite"), std::invalid_argument);
    CHECK_THROWS_AS(merge_journals({longer}, longer), std::invalid_argument);
}
