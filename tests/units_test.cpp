#include "model/units.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using percuss::model::format_quantity;
using percuss::model::parse_plain_number;
using percuss::model::parse_quantity;

namespace {

/// The message of the refusal, or "accepted".
std::string refusal(const std::string& text, const std::string& unit) {
    try {
        parse_quantity(text, unit);
    } catch (const std::invalid_argument& error) { return error.what(); }
    return "accepted";
}

bool is_refused(const std::string& text, const std::string& unit) { return refusal(text, unit) != "accepted"; }

}  // namespace

TEST_CASE("decimal prefixes are exact") {
    // Powers of ten act on the digits: the same bits as the SI number written out.
    CHECK(parse_quantity("0.6 mm", "m") == 0.6e-3);
    CHECK(parse_quantity("2.672 g", "kg") == 2.672e-3);
    CHECK(parse_quantity("51.9 N/mm", "N/m") == 51.9e3);
    CHECK(parse_quantity("3.3 kV", "V") == 3.3e3);
    CHECK(parse_quantity("57 Hz", "Hz") == 57.0);
    CHECK(parse_quantity("14 kPa s", "Pa s") == 14e3);
    CHECK(parse_quantity("220 Pa s", "Pa s") == 220.0);
    CHECK(parse_quantity("50 V/um", "V/m") == 50e6);
    CHECK(parse_quantity("50 V/\xC2\xB5m", "V/m") == 50e6);
    CHECK(parse_quantity("1 %", "1") == 0.01);
    CHECK(parse_quantity("1.188 N s/m", "N s/m") == 1.188);
    CHECK(parse_quantity("1.2e2 um", "m") == 1.2e-4);
    CHECK(parse_quantity("5mN.s", "N s") == 5e-3);
    CHECK(parse_quantity("2 kN/m^3", "N/m^3") == 2e3);
    CHECK(parse_quantity("25 s-1", "Hz") == 25.0);
    CHECK(parse_quantity("25 1/s", "Hz") == 25.0);
}

TEST_CASE("other units convert by their definition") {
    CHECK(parse_quantity("1 inch", "m") == doctest::Approx(0.0254).epsilon(1e-15));
    CHECK(parse_quantity("1 lbf", "N") == doctest::Approx(4.4482216152605).epsilon(1e-13));
    CHECK(parse_quantity("2 minutes", "s") == 120.0);
}

TEST_CASE("a bare number is in the unit asked for") {
    CHECK(parse_quantity("0.0006", "m") == 0.0006);
    CHECK(parse_quantity("  -3e2  ", "V") == -300.0);
    CHECK(parse_quantity("+4", "1") == 4.0);
}

TEST_CASE("a wrong dimension is refused and the message says what was expected") {
    const std::string message = refusal("5 kg", "m");
    CHECK(message.find("'5 kg'") != std::string::npos);
    CHECK(message.find("dimension of m") != std::string::npos);
    CHECK(is_refused("5 N", "N/m"));
    CHECK(is_refused("5 mm", "1"));
    CHECK(is_refused("5 s", "Hz"));
}

TEST_CASE("angles do not pass for frequencies") {
    for (const char* text : {"60 rad/s", "3600 rpm", "60 revolutions/s", "60 turns/s", "60 cycles/s", "60 degree/s",
                             "60 rps", "60 cps", "60 Hz rad", "60 arcminute/s"}) {
        CAPTURE(text);
        CHECK(is_refused(text, "Hz"));
    }
    CHECK(is_refused("5 rad", "1"));
    CHECK(is_refused("5 sr", "1"));
    CHECK(parse_quantity("1.2 rad/s", "rad/s") == 1.2);
    CHECK(is_refused("1.2 Hz", "rad/s"));
}

TEST_CASE("what is not one finite number with one unit is refused") {
    for (const char* text :
         {"",      " ",        "mm",       "nan",    "NaN m",           "inf",           "-inf m",   "infinity",
          "1e999", "0x10 mm",  "0x1p3",    "1,5 mm", "1.2.3",           "0.6 2 mm",      "0.6 mm 2", "1 mm foo",
          "1 mm;", "1 mm # x", "--1 mm",   "+-1",    "1 mm since 2000", "5 lg(re 1 mm)", "5 (m)",    "5 m^",
          "5 m/",  "5 m//s",   "1e308 km", "1 m^2^1"}) {
        CAPTURE(text);
        CHECK(is_refused(text, "m"));
    }
    CHECK(is_refused("3 dB", "1"));
    CHECK(is_refused("5 5", "1"));
}

TEST_CASE("scales that do not start at zero are refused") {
    CHECK(is_refused("20 degC", "K"));
    CHECK(is_refused("20 fahrenheit", "K"));
}

TEST_CASE("plain numbers take no unit") {
    CHECK(parse_plain_number(" 1.5 ") == 1.5);
    CHECK_THROWS_AS(parse_plain_number("1.5 mm"), std::invalid_argument);
    CHECK_THROWS_AS(parse_plain_number("1 %"), std::invalid_argument);
    CHECK_THROWS_AS(parse_plain_number("nan"), std::invalid_argument);
}

TEST_CASE("printing picks a handy prefix") {
    CHECK(format_quantity(0.6e-3, "m") == "0.6 mm");
    CHECK(format_quantity(51.9e3, "N/m") == "51.9 N/mm");
    CHECK(format_quantity(220.0, "Pa s") == "220 Pa s");
    CHECK(format_quantity(50e6, "V/m") == "50 V/um");
    CHECK(format_quantity(-3.3e3, "V") == "-3.3 kV");
    CHECK(format_quantity(0.0, "m") == "0 m");
    CHECK(format_quantity(1.1, "1") == "1.1");
    CHECK(format_quantity(1e-12, "m") == "0.001 nm");
}

TEST_CASE("what is printed reads back") {
    for (const double value : {1.5e-7, 2.672e-3, 0.6, 12.0, 1.039e5}) {
        for (const char* unit :
             {"m", "kg", "s", "Pa", "Pa s", "N/m", "V", "Hz", "N", "m/s", "J", "N s", "V/m", "A", "VA"}) {
            CAPTURE(unit);
            CHECK(parse_quantity(format_quantity(value, unit), unit) == doctest::Approx(value).epsilon(1e-5));
        }
    }
}

TEST_CASE("threads may convert at the same time") {
    constexpr int workers = 4;
    std::vector<int> good(workers, 0);
    std::vector<std::thread> threads;
    for (int worker = 0; worker < workers; ++worker) {
        threads.emplace_back([worker, &good] {
            for (int i = 1; i <= 200; ++i) {
                const bool right = parse_quantity(std::to_string(i) + " mm", "m") == i / 1000.0;
                good[static_cast<std::size_t>(worker)] += right && is_refused("1 kg", "m") ? 1 : 0;
            }
        });
    }
    for (std::thread& thread : threads) { thread.join(); }
    CHECK(good == std::vector<int>(workers, 200));
}
