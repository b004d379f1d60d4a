// Which blocks a process computes: "i/N", and "auto" under Slurm, Open MPI and PMI.

#include "results/shard.hpp"

#include <doctest/doctest.h>

#include <map>
#include <set>
#include <stdexcept>
#include <string>

using namespace percuss::results;

namespace {

Environment environment(std::map<std::string, std::string> values) {
    return [values](const char* name) -> std::optional<std::string> {
        const auto found = values.find(name);
        return found == values.end() ? std::nullopt : std::optional<std::string>(found->second);
    };
}

const Environment none = environment({});

std::string refusal(const std::string& text, const Environment& where) {
    try {
        const Shard shard = parse_shard(text, where);
        return "accepted as " + text_of(shard);
    } catch (const std::invalid_argument& error) { return error.what(); }
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("blocks of 64 rows") {
    CHECK(blocks_of(0) == 0);
    CHECK(blocks_of(-5) == 0);
    CHECK(blocks_of(1) == 1);
    CHECK(blocks_of(64) == 1);
    CHECK(blocks_of(65) == 2);
    CHECK(blocks_of(20000) == 313);
    CHECK(rows_in_block(0, 20000) == 64);
    CHECK(rows_in_block(312, 20000) == 32);
    CHECK(rows_in_block(313, 20000) == 0);
    CHECK(rows_in_block(0, 64) == 64);
    CHECK(rows_in_block(1, 64) == 0);
}

TEST_CASE("the shards of a table take each block once") {
    for (const std::int64_t count : {1, 2, 3, 7, 400}) {
        std::set<std::int64_t> taken;
        std::size_t sum = 0;
        for (std::int64_t i = 0; i < count; ++i) {
            for (const std::int64_t block : blocks_of(Shard{i, count}, 20000)) {
                CHECK(block % count == i);
                taken.insert(block);
                ++sum;
            }
        }
        CHECK(taken.size() == 313);
        CHECK(sum == 313);
        CHECK(*taken.rbegin() == 312);
    }
}

TEST_CASE("i/N") {
    CHECK(parse_shard("0/1", none).is_whole());
    CHECK(parse_shard("3/8", none) == Shard{3, 8});
    CHECK(text_of(parse_shard("7/8", none)) == "7/8");
    CHECK(parse_shard("3/8", none).takes(11));
    CHECK_FALSE(parse_shard("3/8", none).takes(12));
    for (const char* text : {"8/8", "-1/8", "0/0", "3", "/8", "3/", "a/8", "3/8x", " 3/8", "1.5/8", "", "3/8/9", "Auto",
                             "99999999999999999999/8"}) {
        CAPTURE(text);
        const std::string message = refusal(text, none);
        CHECK(has(message, text));
        CHECK(has(message, R"("i/N" with whole numbers, i from 0 to N - 1, and "auto")"));
    }
}

TEST_CASE("auto: a Slurm job array, whatever its first id and step") {
    const auto array = [](const char* id, const char* count, const char* smallest, const char* largest) {
        return environment({{"SLURM_ARRAY_TASK_ID", id},
                            {"SLURM_ARRAY_TASK_COUNT", count},
                            {"SLURM_ARRAY_TASK_MIN", smallest},
                            {"SLURM_ARRAY_TASK_MAX", largest}});
    };
    CHECK(parse_shard("auto", array("5", "8", "0", "7")) == Shard{5, 8});
    CHECK(parse_shard("auto", array("1", "8", "1", "8")) == Shard{0, 8});
    CHECK(parse_shard("auto", array("8", "8", "1", "8")) == Shard{7, 8});
    CHECK(parse_shard("auto", array("12", "4", "0", "12")) == Shard{3, 4});
    CHECK(parse_shard("auto", array("0", "1", "0", "0")) == Shard{0, 1});
    CHECK(parse_shard("auto", environment({{"SLURM_ARRAY_TASK_ID", "2"}, {"SLURM_ARRAY_TASK_COUNT", "4"}})) ==
          Shard{2, 4});
    // srun within a task of the array says PMI_SIZE = 1.
    CHECK(parse_shard("auto", environment({{"SLURM_ARRAY_TASK_ID", "2"},
                                           {"SLURM_ARRAY_TASK_COUNT", "4"},
                                           {"PMI_RANK", "0"},
                                           {"PMI_SIZE", "1"}})) == Shard{2, 4});

    CHECK(has(refusal("auto", array("3", "3", "1", "7")), "not evenly spaced"));  // --array=1,3,7
    CHECK(has(refusal("auto", array("2", "3", "0", "9")), "not evenly spaced"));
    CHECK(has(refusal("auto", array("3", "1", "3", "3")), "does not say which shard"));  // --array=3, run again
    CHECK(has(refusal("auto", environment({{"SLURM_ARRAY_TASK_ID", "2"}})), "SLURM_ARRAY_TASK_COUNT is not"));
    CHECK(has(refusal("auto", array("x", "8", "0", "7")), R"(SLURM_ARRAY_TASK_ID = "x" is not a whole number)"));
    CHECK(has(refusal("auto", environment({{"SLURM_ARRAY_TASK_ID", "2"},
                                           {"SLURM_ARRAY_TASK_COUNT", "4"},
                                           {"OMPI_COMM_WORLD_RANK", "1"},
                                           {"OMPI_COMM_WORLD_SIZE", "3"}})),
              "one of several MPI ranks"));
}

TEST_CASE("auto: Open MPI and PMI ranks, and nothing to go by") {
    CHECK(parse_shard("auto", environment({{"OMPI_COMM_WORLD_RANK", "2"}, {"OMPI_COMM_WORLD_SIZE", "3"}})) ==
          Shard{2, 3});
    CHECK(parse_shard("auto", environment({{"PMI_RANK", "0"}, {"PMI_SIZE", "5"}})) == Shard{0, 5});
    CHECK(has(refusal("auto", environment({{"PMI_RANK", "0"}})), "only one is set"));
    CHECK(has(refusal("auto", environment({{"PMI_RANK", "5"}, {"PMI_SIZE", "5"}})), "shard 5 of 5"));
    CHECK(has(refusal("auto", none), "none of SLURM_ARRAY_TASK_ID, OMPI_COMM_WORLD_RANK and PMI_RANK is set"));
    // An explicit shard wins over any environment.
    CHECK(parse_shard("1/2", environment({{"PMI_RANK", "0"}, {"PMI_SIZE", "5"}})) == Shard{1, 2});
}
