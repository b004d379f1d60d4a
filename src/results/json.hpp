#pragma once
/// \file
/// JSON values: built, printed and read.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace percuss::results {

/// A JSON value; objects keep the order in which their members were added. NaN is printed as null, every other number
/// so that it reads back to the same bits.
class Json {
public:
    struct Member;
    using Array = std::vector<Json>;
    using Object = std::vector<Member>;

    Json() = default;
    Json(std::nullptr_t) {}                                // NOLINT(google-explicit-constructor): a value as it is
    Json(bool value) : value_(value) {}                    // NOLINT(google-explicit-constructor)
    Json(double value) : value_(value) {}                  // NOLINT(google-explicit-constructor)
    Json(std::string value) : value_(std::move(value)) {}  // NOLINT(google-explicit-constructor)
    Json(std::string_view value) : value_(std::string(value)) {}  // NOLINT(google-explicit-constructor)
    Json(const char* value) : value_(std::string(value)) {}       // NOLINT(google-explicit-constructor)
    template <std::integral Integer>
    Json(Integer value) {  // NOLINT(google-explicit-constructor)
        if constexpr (std::unsigned_integral<Integer>) {
            value_ = static_cast<std::uint64_t>(value);
        } else {
            value_ = static_cast<std::int64_t>(value);
        }
    }
    template <class Item>
    Json(const std::vector<Item>& items) {  // NOLINT(google-explicit-constructor)
        Array out;
        for (const auto& item : items) { out.emplace_back(item); }
        value_ = std::move(out);
    }
    /// An object: {{"name", value}, ...}.
    Json(std::initializer_list<Member> members);

    static Json object();
    static Json array(std::initializer_list<Json> items = {});

    /// The member of an object with this name, added if it is not there; null becomes an object.
    Json& operator[](std::string_view name);
    /// Appends to an array; null becomes an array.
    void push_back(Json item);

    /// The member of an object, or null.
    [[nodiscard]] const Json* find(std::string_view name) const;
    /// The text of a string; empty for anything else.
    [[nodiscard]] std::string text() const;
    /// The items of an array; none for anything else.
    [[nodiscard]] const Array& items() const;

    using Value = std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Array, Object>;
    [[nodiscard]] const Value& value() const { return value_; }

private:
    Value value_;
};

struct Json::Member {
    std::string name;
    Json value;
};

/// With two blanks of indentation and a new line at the end; bytes that are not UTF-8 are replaced.
std::string printed(const Json& document);

/// A document from text; null if it is none.
Json parsed(const std::string& text);

}  // namespace percuss::results
