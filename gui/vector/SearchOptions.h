#pragma once

#include "vectorlib/correspondence/CorrespondenceFinder.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace hermes::vector {

/// The options of the correspondence search: --max-dx --max-dy --max-dalpha --reliability --ambiguity
/// --k-alpha --k-xy --discrepancy. Defaults are those of the thesis appendices.
struct SearchOptions {
    /// discrepancy tells people what holds where that option is not given.
    void addTo(CLI::App &command, const std::string &discrepancy);
    /// Whether any of the options was given.
    bool isGiven() const;
    /// The settings with what was given on top.
    vectorlib::SearchSettings over(vectorlib::SearchSettings settings) const;

private:
    std::optional<double> maxDx_, maxDy_, maxDalpha_, reliability_, ambiguity_, kAlpha_, kXy_, discrepancy_;
};

} // namespace hermes::vector
