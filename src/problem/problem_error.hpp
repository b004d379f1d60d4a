#pragma once
/// \file

#include <stdexcept>

namespace percuss::problem {

/// Something the user gave cannot be used: a problem file, an option, a results folder. The message is one sentence
/// that names what was given and what is allowed.
class ProblemError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace percuss::problem
