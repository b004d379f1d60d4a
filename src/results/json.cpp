#include "results/json.hpp"

#include <utility>

#include <nlohmann/json.hpp>

namespace percuss::results {

namespace {

using Writer = nlohmann::ordered_json;

constexpr int indentation = 2;

/// As the library wants it; the order of members is kept.
Writer to_writer(const Json& json) {
    return std::visit(
        [](const auto& value) -> Writer {
            using Value = std::decay_t<decltype(value)>;
            if constexpr (std::is_same_v<Value, Json::Array>) {
                Writer out = Writer::array();
                for (const Json& item : value) { out.push_back(to_writer(item)); }
                return out;
            } else if constexpr (std::is_same_v<Value, Json::Object>) {
                Writer out = Writer::object();
                for (const Json::Member& member : value) { out[member.name] = to_writer(member.value); }
                return out;
            } else {
                return value;
            }
        },
        json.value());
}

/// The way back; whatever else the library knows (binary, discarded) becomes null.
Json from_reader(const Writer& in) {
    if (in.is_object()) {
        Json out = Json::object();
        for (const auto& [name, value] : in.items()) { out[name] = from_reader(value); }
        return out;
    }
    if (in.is_array()) {
        Json out = Json::array();
        for (const Writer& item : in) { out.push_back(from_reader(item)); }
        return out;
    }
    if (in.is_string()) { return in.get<std::string>(); }
    if (in.is_boolean()) { return in.get<bool>(); }
    // Before the general case: a double has room for 53 bits only.
    if (in.is_number_integer()) { return in.get<std::int64_t>(); }
    if (in.is_number()) { return in.get<double>(); }
    return nullptr;
}

}  // namespace

Json::Json(std::initializer_list<Member> members) : value_(Object(members)) {}

Json Json::object() {
    Json out;
    out.value_ = Object();
    return out;
}

Json Json::array(std::initializer_list<Json> items) {
    Json out;
    out.value_ = Array(items);
    return out;
}

Json& Json::operator[](std::string_view name) {
    if (std::holds_alternative<std::nullptr_t>(value_)) { value_ = Object(); }
    auto& members = std::get<Object>(value_);
    for (Member& member : members) {
        if (member.name == name) { return member.value; }
    }
    return members.emplace_back(Member{std::string(name), nullptr}).value;
}

void Json::push_back(Json item) {
    if (std::holds_alternative<std::nullptr_t>(value_)) { value_ = Array(); }
    std::get<Array>(value_).push_back(std::move(item));
}

const Json* Json::find(std::string_view name) const {
    if (const auto* members = std::get_if<Object>(&value_)) {
        for (const Member& member : *members) {
            if (member.name == name) { return &member.value; }
        }
    }
    return nullptr;
}

std::string Json::text() const {
    const auto* held = std::get_if<std::string>(&value_);
    return held == nullptr ? "" : *held;
}

const Json::Array& Json::items() const {
    static const Array none;
    const auto* held = std::get_if<Array>(&value_);
    return held == nullptr ? none : *held;
}

std::string printed(const Json& document) {
    // Names of files need not be UTF-8; a result is not lost for one: what is not valid is replaced. NaN is written as
    // null.
    return to_writer(document).dump(indentation, ' ', false, Writer::error_handler_t::replace) + "\n";
}

Json parsed(const std::string& text) {
    // A broken document is a value that has no members, not an exception: what is read here may be anything.
    const Writer document = Writer::parse(text, nullptr, false);
    return document.is_discarded() ? Json() : from_reader(document);
}

}  // namespace percuss::results
