#include "gui/vector/SearchOptions.h"

#include "gui/vector/Options.h"

namespace hermes::vector {

void SearchOptions::addTo(CLI::App &command, const std::string &discrepancy) {
    const auto number = [&command](const char *usage, std::optional<double> &value, const std::string &what,
                                   double low, double high) {
        addOption(command, usage, value, between(low, high), what)->group("Search");
    };
    number("--max-dx M", maxDx_, "Permitted motion, metres (1.2)", 0, 1e6);
    number("--max-dy M", maxDy_, "Permitted motion, metres (1.2)", 0, 1e6);
    number("--max-dalpha RAD", maxDalpha_, "Permitted rotation, radians (1.26)", 0, vectorlib::pi);
    number("--reliability R", reliability_, "Least reliability (0.1)", 0, 1);
    number("--ambiguity A", ambiguity_, "Most ambiguity of a pair, m^2 (0.0025)", 0, 1e6);
    number("--k-alpha K", kAlpha_, "Weight of the rotation in the ambiguity, m^2/rad^2 (0.1)", 0, 1e12);
    number("--k-xy K", kXy_, "Weight of the translation in the ambiguity (1)", 0, 1e12);
    number("--discrepancy A", discrepancy_, "Most discrepancy, m^2 (" + discrepancy + ")", 0, 1e12);
}

bool SearchOptions::isGiven() const {
    return maxDx_ || maxDy_ || maxDalpha_ || reliability_ || ambiguity_ || kAlpha_ || kXy_ || discrepancy_;
}

vectorlib::SearchSettings SearchOptions::over(vectorlib::SearchSettings s) const {
    s.permitted.dx = maxDx_.value_or(s.permitted.dx);
    s.permitted.dy = maxDy_.value_or(s.permitted.dy);
    s.permitted.dalpha = maxDalpha_.value_or(s.permitted.dalpha);
    s.reliability = reliability_.value_or(s.reliability);
    s.ambiguity = ambiguity_.value_or(s.ambiguity);
    s.stiffness.alpha = kAlpha_.value_or(s.stiffness.alpha);
    s.stiffness.xy = kXy_.value_or(s.stiffness.xy);
    s.discrepancy = discrepancy_.value_or(s.discrepancy);
    return s;
}

} // namespace hermes::vector
