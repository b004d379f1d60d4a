#include "verbs/explore/explore.hpp"

#include "design/evaluate.hpp"
#include "verbs/explore/exploration_text.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

namespace percuss::verbs {

namespace {

using results::RowBlock;

/// Blocks handed from the threads that compute them to the one that writes them.
class Exchange {
public:
    explicit Exchange(int workers) : running_(workers) {}

    void put(RowBlock block) {
        const std::lock_guard lock(mutex_);
        finished_.push_back(std::move(block));
        changed_.notify_one();
    }
    void leave(std::exception_ptr error) {
        const std::lock_guard lock(mutex_);
        if (!error_) { error_ = std::move(error); }
        --running_;
        changed_.notify_one();
    }

    /// What has been finished since; waits for something a moment. `is_over`: nothing more will come.
    std::deque<RowBlock> take(bool& is_over) {
        // Often enough for progress to be seen to move.
        constexpr auto moment = std::chrono::milliseconds(200);
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, moment, [&] { return !finished_.empty() || running_ == 0; });
        is_over = running_ == 0;
        return std::exchange(finished_, {});
    }
    void rethrow() const {
        if (error_) { std::rethrow_exception(error_); }
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<RowBlock> finished_;
    std::exception_ptr error_;
    int running_;
};

/// One run of the verb.
class Run {
public:
    Run(const StudyProblem& problem, const Exploration& exploration, results::Journal& journal,
        const Observer& observer, const numerics::CancelRequest& cancelled)
        : exploration_(exploration),
          journal_(journal),
          observer_(observer),
          cancelled_(cancelled),
          jobs_(problem.jobs),
          evaluator_(single_threaded(problem)),
          missing_(journal.missing_blocks(exploration.space().rows())) {
        for (const std::int64_t block : results::blocks_of(journal.shard(), rows())) {
            wanted_ += results::rows_in_block(block, rows());
        }
        for (const std::int64_t block : missing_) { to_do_ += results::rows_in_block(block, rows()); }
    }

    ExploreProgress run() {
        Exchange exchange(jobs_);
        std::vector<std::jthread> workers;
        workers.reserve(static_cast<std::size_t>(jobs_));
        const Stopper stopper{*this};  // before the threads are joined, whatever happens here
        for (int i = 0; i < jobs_; ++i) {
            workers.emplace_back([&] { work(exchange); });
        }
        for (bool is_over = false; !is_over;) {
            for (const RowBlock& block : exchange.take(is_over)) { write(block); }
            report_progress();
        }
        workers.clear();
        exchange.rethrow();
        ExploreProgress progress;
        progress.designs = written_;
        progress.is_complete = journal_.missing_blocks(rows()).empty();
        progress.seconds = seconds();
        return progress;
    }

private:
    struct Stopper {
        Run& run;
        ~Stopper() { run.stopped_ = true; }
    };

    /// Designs are what is done at once here, not the starts of one of them.
    static design::Problem single_threaded(const StudyProblem& problem) {
        design::Problem design = design_problem(problem);
        design.sampling.jobs = 1;
        return design;
    }

    [[nodiscard]] std::int64_t rows() const { return exploration_.space().rows(); }
    [[nodiscard]] bool is_cancelled() const { return stopped_ || (cancelled_ && cancelled_()); }
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
    }

    void work(Exchange& exchange) {
        std::exception_ptr error;
        try {
            for (std::size_t i = next_++; i < missing_.size() && !is_cancelled(); i = next_++) {
                RowBlock block = evaluate_block(missing_[i]);
                if (is_cancelled()) { break; }  // designs cut short are no rows
                exchange.put(std::move(block));
            }
        } catch (...) {
            error = std::current_exception();
            stopped_ = true;
        }
        exchange.leave(std::move(error));
    }

    RowBlock evaluate_block(std::int64_t number) {
        RowBlock block{number, {}};
        const std::int64_t first = number * results::rows_per_block;
        for (const DesignPoint& point : exploration_.space().points(first, results::rows_in_block(number, rows()))) {
            if (is_cancelled()) { break; }
            block.rows.push_back(evaluate_design(point));
            ++evaluated_;
        }
        return block;
    }

    results::Row evaluate_design(const DesignPoint& point) {
        model::Specification actuator = evaluator_.problem().actuator;
        const auto& variables = exploration_.space().variables();
        for (std::size_t j = 0; j < variables.size(); ++j) { actuator.set(variables[j].key, point.values[j]); }
        design::Demand demand = exploration_.layout().demand();
        demand.cancelled = [this] { return is_cancelled(); };
        try {
            return exploration_.layout().row(actuator, evaluator_.evaluate(actuator, demand));
        } catch (const std::bad_alloc&) {
            throw;  // says nothing about the design
        } catch (const std::exception& error) {
            // Ranges may overlap where the actuator makes no sense (an outer radius below the inner one): such a design
            // is one row among many, not the end of the run.
            return exploration_.layout().failed_row(actuator, error.what());
        }
    }

    void write(const RowBlock& block) {
        journal_.write(block);
        written_ += static_cast<std::int64_t>(block.rows.size());
    }

    void report_progress() const {
        if (!observer_ || wanted_ == 0) { return; }
        const std::int64_t done = wanted_ - to_do_ + evaluated_;
        const double rate = static_cast<double>(evaluated_) / seconds();
        observer_(static_cast<double>(done) / static_cast<double>(wanted_),
                  std::to_string(done) + " of " + std::to_string(wanted_) + " designs, " +
                      std::to_string(static_cast<std::int64_t>(rate)) + " a second");
    }

    const Exploration& exploration_;
    results::Journal& journal_;
    const Observer& observer_;
    const numerics::CancelRequest& cancelled_;
    int jobs_;
    design::Evaluator evaluator_;
    std::vector<std::int64_t> missing_;
    std::int64_t wanted_ = 0;  ///< rows of this shard
    std::int64_t to_do_ = 0;
    std::int64_t written_ = 0;
    std::atomic<std::size_t> next_ = 0;
    std::atomic<std::int64_t> evaluated_ = 0;
    std::atomic<bool> stopped_ = false;
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

}  // namespace

Exploration::Exploration(const problem::ProblemFile& problem, const std::string& instruction_set)
    : space_(problem.design.variables, problem.get<ExploreOptions>(), problem.design.sampling.seed),
      layout_(problem, problem.get<ExploreOptions>()),
      work_{explore_kind, exploration_text(problem, instruction_set), layout_.journal_columns()} {}

ExploreProgress explore(const StudyProblem& problem, const Exploration& exploration, results::Journal& journal,
                        const Observer& observer, const numerics::CancelRequest& cancelled) {
    return Run(problem, exploration, journal, observer, cancelled).run();
}

}  // namespace percuss::verbs
