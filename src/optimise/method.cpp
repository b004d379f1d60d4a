#include "optimise/method.hpp"

#include "optimise/ipopt_solver.hpp"
#include "optimise/nlopt_solver.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace percuss::optimise {
namespace {

std::vector<Method> joined(std::initializer_list<std::vector<Method>> libraries) {
    std::vector<Method> table;
    for (const std::vector<Method>& rows : libraries) table.insert(table.end(), rows.begin(), rows.end());
    return table;
}

/// "1 variable", "2 variables".
std::string counted(int count, const char* noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace

const std::vector<Method>& method_table() {
    static const std::vector<Method> table = joined({ipopt_methods(), nlopt_methods()});
    return table;
}

const Method& find_method(const std::string& name) {
    const auto& table = method_table();
    const auto found = std::find_if(table.begin(), table.end(), [&](const Method& m) { return m.name == name; });
    if (found != table.end()) return *found;
    std::string message = "method = " + name + ", must be one of";
    for (const Method& known : table) message += " " + known.name;
    throw std::invalid_argument(message);
}

void check_fits(const Method& method, const MemoisedNlp& nlp) {
    const Capabilities& can = method.capabilities;
    const int n = nlp.variables();
    const int m = nlp.constraints();
    std::ostringstream message;
    message << "method = " << method.name << ": ";
    if (can.global && !(nlp.lower().allFinite() && nlp.upper().allFinite())) {
        message << "it is global and needs finite bounds for every variable";
    } else if (n < can.least_variables) {
        message << counted(n, "variable") << ", must be at least " << can.least_variables;
    } else if (n > can.most_variables || m > can.most_constraints) {
        message << counted(n, "variable") << " and " << counted(m, "constraint") << ", must be at most "
                << can.most_variables << " and " << can.most_constraints;
    } else {
        return;
    }
    throw std::invalid_argument(message.str());
}

}  // namespace percuss::optimise
