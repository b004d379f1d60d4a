// Checks every #include line under src/ against the architecture: folders depend only on earlier folders, and
// third-party headers stay out of our headers.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fs = std::filesystem;

namespace {

struct Include {
    std::string path;
    bool quoted = false;
    int line = 0;
};

struct ScanResult {
    int files = 0;
    std::vector<std::string> violations;  // "folder/file.cpp:12: what is wrong"
};

/// The folders of src/ in dependency order, as the build lists them.
const std::vector<std::string>& folder_order() {
    static const std::vector<std::string> order = [] {
        std::istringstream words{PERCUSS_FOLDER_ORDER};
        return std::vector<std::string>{std::istream_iterator<std::string>{words}, {}};
    }();
    return order;
}

/// Position of a folder in the dependency order; nothing if it is not part of the architecture.
std::optional<std::ptrdiff_t> rank_of(const std::string& folder) {
    const auto& order = folder_order();
    const auto found = std::find(order.begin(), order.end(), folder);
    if (found == order.end()) { return std::nullopt; }
    return found - order.begin();
}

/// First component of an include path; empty if there is only a file name.
std::string folder_of(const std::string& path) {
    const auto slash = path.find('/');
    return slash == std::string::npos ? std::string{} : path.substr(0, slash);
}

bool is_eigen(const std::string& path) { return path.starts_with("Eigen/") || path.starts_with("unsupported/Eigen/"); }

/// Standard headers have neither a folder nor an extension; the C library and the compiler add a few with ".h".
bool is_standard_or_system(const std::string& path) {
    static const std::regex standard{"[a-z0-9_]+"};
    static const std::regex system{"(sys|bits|linux|asm)/.*\\.h|(unistd|fcntl|signal|termios|poll|pthread|sched|dlfcn|"
                                   "time|cpuid|immintrin|x86intrin|arm_neon|quadmath)\\.h"};
    return std::regex_match(path, standard) || std::regex_match(path, system);
}

std::vector<Include> read_includes(const fs::path& file) {
    static const std::regex pattern{R"(^\s*#\s*(?:include|import)\s*([<"])([^>"]+)[>"].*)"};
    std::ifstream in{file};
    if (!in) { throw std::runtime_error("cannot read " + file.string()); }
    std::vector<Include> includes;
    std::string text;
    for (int line = 1; std::getline(in, text); ++line) {
        std::smatch match;
        if (std::regex_match(text, match, pattern)) {
            includes.push_back({.path = match[2], .quoted = match[1] == "\"", .line = line});
        }
    }
    return includes;
}

/// What is wrong with one include of the file `folder/name`, or nothing.
std::optional<std::string> judge(const Include& include, const std::string& folder, const std::string& name) {
    const std::string target = folder_of(include.path);
    if (const auto target_rank = rank_of(target)) {
        if (!include.quoted) { return "own header <" + include.path + "> needs quotes"; }
        const auto own_rank = rank_of(folder);
        if (own_rank && *target_rank > *own_rank) {
            return folder + " may not include \"" + include.path + "\": " + target + " comes later";
        }
        return std::nullopt;
    }
    if (include.quoted) { return "\"" + include.path + "\" does not start with a folder of src/"; }
    if (is_eigen(include.path)) {
        if (folder == "numerics" && name == "linear.hpp") { return std::nullopt; }
        return "<" + include.path + "> may be included only by numerics/linear.hpp";
    }
    if (!is_standard_or_system(include.path) && !name.ends_with(".cpp")) {
        return "third-party <" + include.path + "> may be included only by a .cpp file";
    }
    return std::nullopt;
}

bool is_source(const fs::path& file) {
    static const std::initializer_list<std::string_view> extensions = {".cpp", ".hpp", ".cc",  ".cxx", ".c",
                                                                       ".h",   ".hxx", ".ipp", ".inl", ".tpp"};
    const std::string extension = file.extension().string();
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

/// Reads every source file under `root` (a src/ folder) and lists what breaks the rules, sorted by file.
/// Throws std::filesystem::filesystem_error if `root` cannot be read.
ScanResult scan_tree(const fs::path& root) {
    ScanResult result;
    for (const auto& entry : fs::directory_iterator{root}) {
        if (entry.is_directory() && !rank_of(entry.path().filename().string())) {
            result.violations.push_back(entry.path().filename().string() + ": folder is not in the list");
        }
    }
    for (const auto& entry : fs::recursive_directory_iterator{root}) {
        if (!entry.is_regular_file() || !is_source(entry.path())) { continue; }
        ++result.files;
        const std::string relative = entry.path().lexically_relative(root).generic_string();
        const std::string folder = folder_of(relative);
        if (folder.empty()) {
            result.violations.push_back(relative + ": file is in no folder");
            continue;
        }
        for (const Include& include : read_includes(entry.path())) {
            if (const auto reason = judge(include, folder, relative.substr(folder.size() + 1))) {
                result.violations.push_back(relative + ":" + std::to_string(include.line) + ": " + *reason);
            }
        }
    }
    std::sort(result.violations.begin(), result.violations.end());
    return result;
}

/// A src/ tree in the temporary folder, removed at the end of the test.
class TemporaryTree {
public:
    TemporaryTree() {
        std::string name = (fs::temp_directory_path() / "percuss-include-order-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) { throw std::runtime_error("cannot create " + name); }
        root_ = name;
    }
    TemporaryTree(const TemporaryTree&) = delete;
    TemporaryTree& operator=(const TemporaryTree&) = delete;
    ~TemporaryTree() {
        std::error_code ignored;
        fs::remove_all(root_, ignored);
    }

    void write(const fs::path& file, const std::string& text) const {
        fs::create_directories((root_ / file).parent_path());
        std::ofstream{root_ / file} << text;
    }
    const fs::path& root() const { return root_; }

private:
    fs::path root_;
};

/// The violations of a tree that holds this one file.
std::vector<std::string> violations_of(const fs::path& file, const std::string& text) {
    const TemporaryTree tree;
    tree.write(file, text);
    return scan_tree(tree.root()).violations;
}

}  // namespace

TEST_CASE("the source tree keeps the order of its folders") {
    const char* source_dir = std::getenv("PERCUSS_SOURCE_DIR");
    REQUIRE(source_dir != nullptr);
    const ScanResult result = scan_tree(fs::path{source_dir} / "src");
    CHECK(result.files > 0);
    for (const std::string& violation : result.violations) { FAIL_CHECK(violation); }
}

TEST_CASE("a tree that keeps the rules has no violations") {
    const TemporaryTree tree;
    tree.write("numerics/linear.hpp", "#pragma once\n#include <Eigen/Dense>\n#include <vector>\n");
    tree.write("flow/flow.hpp",
               "#include \"flow/taylor.hpp\"\n#include \"numerics/linear.hpp\"\n#include <immintrin.h>\n");
    tree.write("flow/cvodes.cpp",
               "#include <cvodes/cvodes.h>\n  #  include \"model/scene.hpp\"\n// #include \"cli/a.hpp\"\n");
    tree.write("optimise/ipopt.cpp", "#include <IpTNLP.hpp>\n#include <sys/types.h>\n");
    tree.write("cli/main.cpp", "#include \"verbs/evaluate/evaluate.hpp\"\n");
    tree.write("cli/notes.txt", "#include \"nowhere.hpp\"\n");
    const ScanResult result = scan_tree(tree.root());
    CHECK(result.files == 5);
    CHECK(result.violations == std::vector<std::string>{});
}

TEST_CASE("a broken rule is found, with file and line") {
    using Lines = std::vector<std::string>;

    CHECK(violations_of("flow/flow.hpp", "#pragma once\n#include \"orbit/orbit.hpp\"\n") ==
          Lines{"flow/flow.hpp:2: flow may not include \"orbit/orbit.hpp\": orbit comes later"});
    CHECK(violations_of("model/deep/a.cpp", "#include \"cli/b.hpp\"\n") ==
          Lines{"model/deep/a.cpp:1: model may not include \"cli/b.hpp\": cli comes later"});
    CHECK(violations_of("verbs/orbit/a.cpp", "#include \"verbs/branch/b.hpp\"\n#include \"cli/b.hpp\"\n") ==
          Lines{"verbs/orbit/a.cpp:2: verbs may not include \"cli/b.hpp\": cli comes later"});
    CHECK(violations_of("problem/a.cpp", "#include \"results/json.hpp\"\n") ==
          Lines{"problem/a.cpp:1: problem may not include \"results/json.hpp\": results comes later"});
    CHECK(violations_of("orbit/a.cpp", "#include <flow/flow.hpp>\n") ==
          Lines{"orbit/a.cpp:1: own header <flow/flow.hpp> needs quotes"});
    CHECK(violations_of("orbit/a.cpp", "#include \"orbit.hpp\"\n") ==
          Lines{"orbit/a.cpp:1: \"orbit.hpp\" does not start with a folder of src/"});
    CHECK(violations_of("orbit/a.cpp", "#include \"../flow/flow.hpp\"\n") ==
          Lines{"orbit/a.cpp:1: \"../flow/flow.hpp\" does not start with a folder of src/"});
    CHECK(violations_of("numerics/newton.hpp", "#include <Eigen/LU>\n") ==
          Lines{"numerics/newton.hpp:1: <Eigen/LU> may be included only by numerics/linear.hpp"});
    CHECK(violations_of("flow/linear.hpp", "#include <Eigen/LU>\n") ==
          Lines{"flow/linear.hpp:1: <Eigen/LU> may be included only by numerics/linear.hpp"});
    CHECK(violations_of("orbit/a.cpp", "#include <unsupported/Eigen/MatrixFunctions>\n") ==
          Lines{"orbit/a.cpp:1: <unsupported/Eigen/MatrixFunctions> may be included only by numerics/linear.hpp"});
    CHECK(violations_of("extras/a.cpp", "") == Lines{"extras: folder is not in the list"});
    CHECK(violations_of("a.cpp", "") == Lines{"a.cpp: file is in no folder"});
}

TEST_CASE("no third-party header may stand in one of our headers") {
    const std::vector<std::string> third_party = {
        "IpTNLP.hpp",         "coin/IpTNLP.hpp",   "nlopt.hpp",  "cvodes/cvodes.h", "sundials/sundials_types.h",
        "nvector/nvector.h",  "nlohmann/json.hpp", "fmt/core.h", "udunits2.h",      "boost/program_options.hpp",
        "tbb/parallel_for.h", "doctest/doctest.h",
    };
    for (const std::string& header : third_party) {
        CAPTURE(header);
        const std::string line = "#include <" + header + ">\n";
        CHECK(violations_of("results/a.cpp", line).empty());
        const std::vector<std::string> found = violations_of("results/a.hpp", line);
        REQUIRE(found.size() == 1);
        CHECK(found[0] == "results/a.hpp:1: third-party <" + header + "> may be included only by a .cpp file");
        CHECK(violations_of("results/a.ipp", line).size() == 1);
    }
}
