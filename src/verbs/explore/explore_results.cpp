#include "verbs/explore/explore_results.hpp"

#include "results/csv_table.hpp"
#include "verbs/explore/explore_documents.hpp"

#include <chrono>
#include <optional>
#include <utility>

namespace percuss::verbs {

namespace {

using results::CsvTable;
using results::Journal;
using results::RowBlock;

/// Reading a journal out must not keep a user waiting who has pressed Ctrl-C: after half a second it is given up, so
/// that the program ends within one. The journal has everything.
class Patience {
public:
    explicit Patience(bool is_short) : is_short_(is_short) {}
    [[nodiscard]] bool is_over() const {
        constexpr auto half_a_second = std::chrono::milliseconds(500);
        return is_short_ && std::chrono::steady_clock::now() - begun_ > half_a_second;
    }

private:
    bool is_short_;
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

/// designs.csv.
class DesignTable {
public:
    DesignTable(const std::filesystem::path& file, const TableLayout& layout) : layout_(layout), csv_(file) {
        std::vector<Column> columns = {{"row", ""}};
        for (const std::size_t place : layout.shown()) {
            const results::JournalColumn& column = layout.journal_columns()[place];
            columns.push_back({column.name, column.unit});
        }
        csv_.header(columns);
    }

    void add(std::int64_t number, const results::Row& row) {
        cells_.clear();
        cells_.push_back(std::to_string(number));
        for (const std::size_t place : layout_.shown()) {
            const results::Cell& cell = row.at(place);
            const auto* value = std::get_if<double>(&cell);
            cells_.push_back(value != nullptr ? results::cell(*value) : std::get<std::string>(cell));
        }
        csv_.row(std::span<const std::string>(cells_));
    }

    void discard() { csv_.discard(); }

private:
    const TableLayout& layout_;
    CsvTable csv_;
    std::vector<std::string> cells_;
};

struct Stopped {};  // leaves for_each_block

}  // namespace

std::vector<std::string> exploration_files(const ExploreOptions& options) {
    std::vector<std::string> files = {designs_file};
    if (options.sensitivities) { files.emplace_back(sensitivities_file); }
    const std::string journal = results::journal_name;
    for (const char* ending : {"", "-wal", "-shm", "-journal"}) { files.push_back(journal + ending); }
    return files;
}

Outcome conclude_exploration(Session& session, const Exploration& exploration, const Journal& journal,
                             const ExploreFacts& facts) {
    const problem::ProblemFile& problem = session.problem();
    const TableLayout& layout = exploration.layout();
    const Patience patience(facts.is_in_a_hurry);
    ExploreAccount account{facts, Survey(problem.design, layout), {}, journal.shard(), 0, true};
    for (const std::int64_t block : results::blocks_of(journal.shard(), exploration.space().rows())) {
        account.wanted += results::rows_in_block(block, exploration.space().rows());
    }
    std::optional<SensitivityStudy> sensitivities;
    if (problem.get<ExploreOptions>().sensitivities && !facts.is_in_a_hurry) {
        sensitivities.emplace(layout, exploration.space(), problem.design.sampling.seed);
    }
    std::optional<DesignTable> table;
    if (session.folder() != nullptr) { table.emplace(session.folder()->path() / designs_file, layout); }

    const auto read = [&](const RowBlock& block) {
        const std::int64_t first = block.number * results::rows_per_block;
        std::vector<DesignPoint> points;
        if (sensitivities) { points = exploration.space().points(first, static_cast<std::int64_t>(block.rows.size())); }
        for (std::size_t i = 0; i < block.rows.size(); ++i) {
            const std::int64_t number = first + static_cast<std::int64_t>(i);
            account.survey.add(number, block.rows[i]);
            if (table) { table->add(number, block.rows[i]); }
            if (sensitivities) { sensitivities->add(number, points[i], block.rows[i]); }
        }
        if (patience.is_over()) { throw Stopped(); }
    };
    try {
        journal.for_each_block(read);
    } catch (const Stopped&) {
        account.has_table = false;
        if (table) { table->discard(); }
    }
    table.reset();
    if (sensitivities) {
        account.sensitivities = sensitivities->estimate();
        session.write(sensitivities_file, sensitivities_csv(problem, account.sensitivities));
    }

    Outcome outcome;
    outcome.ending = facts.ending;
    outcome.status = status_of(account);
    outcome.reason = facts.reason;
    outcome.document = explore_document(problem, layout, account);
    outcome.presentation = present_exploration(problem, layout, account);
    outcome.resumable = facts.ending != Ending::verified;
    if (outcome.ending == Ending::verified && account.survey.with_status(design::EvaluationStatus::failed) > 0) {
        outcome.ending = Ending::some_failed;
        outcome.reason = std::to_string(account.survey.with_status(design::EvaluationStatus::failed)) + " of " +
                         std::to_string(account.survey.rows()) + " designs could not be evaluated: see their cause";
    }
    return outcome;
}

}  // namespace percuss::verbs
