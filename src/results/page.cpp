#include "results/page.hpp"

namespace percuss::results {

namespace {

constexpr std::string_view style = R"(
body { font: 15px/1.45 sans-serif; margin: 2em auto; max-width: 62em; padding: 0 1em; color: #1d2733; }
h1 { font-size: 1.5em; border-bottom: 2px solid #b4532a; padding-bottom: .2em; }
h2 { font-size: 1.1em; margin-top: 1.6em; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; }
th, td { text-align: left; padding: .2em 1em .2em 0; border-bottom: 1px solid #dde3e8; vertical-align: top; }
th { font-weight: 600; color: #55636f; }
td { font-variant-numeric: tabular-nums; }
footer { margin-top: 2.5em; color: #55636f; font-size: .85em; }
)";

/// Names and messages may hold anything; in a page they must stay text.
std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&': out += "&amp;"; break;
            case '<': out += "&lt;"; break;
            case '>': out += "&gt;"; break;
            case '"': out += "&quot;"; break;
            default: out += c;
        }
    }
    return out;
}

std::string cells(const std::vector<std::string>& texts, std::string_view tag) {
    std::string row = "<tr>";
    for (const std::string& text : texts) {
        row += "<" + std::string(tag) + ">" + escaped(text) + "</" + std::string(tag) + ">";
    }
    return row + "</tr>\n";
}

std::string section(const Block& block) {
    std::string html;
    if (!block.heading.empty()) { html += "<h2>" + escaped(block.heading) + "</h2>\n"; }
    if (!block.sentence.empty()) { html += "<p>" + escaped(block.sentence) + "</p>\n"; }
    if (!block.columns.empty()) {
        html += "<div class=\"scroll\"><table>\n" + cells(block.columns, "th");
        for (const auto& row : block.rows) { html += cells(row, "td"); }
        html += "</table></div>\n";
    }
    return html;
}

}  // namespace

std::string report_page(const Presentation& presentation, const problem::ProblemFile& problem,
                        const std::string& instruction_set) {
    std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
                       escaped(presentation.title) + "</title>\n<style>" + std::string(style) +
                       "</style>\n</head>\n<body>\n<h1>" + escaped(presentation.title) + "</h1>\n";
    for (const Block& block : presentation.blocks) { html += section(block); }
    html += section(settings_block(problem));
    html += "<footer>percuss " PERCUSS_VERSION ", compiler " __VERSION__ ", instruction set " +
            escaped(instruction_set) + ", seed " + std::to_string(problem.design.sampling.seed) + ", problem hash " +
            problem::problem_hash(problem) + "</footer>\n</body>\n</html>\n";
    return html;
}

}  // namespace percuss::results
