#include "model/contact_law.hpp"

namespace percuss::model {

const ContactRules& contact_rules(ContactLaw law, bool damped) {
    return contact_table::rules.at(static_cast<std::size_t>(law))[damped ? 0 : 1];
}

}  // namespace percuss::model
