#pragma once

#include "CampaignCase.h"

#include <map>
#include <set>

namespace campaign {

/// How a case went.
struct Outcome {
    std::string failure;                   ///< empty: as it should
    std::set<std::string> beyond;          ///< what software cannot promise
    std::map<std::string, double> slowest; ///< see StandJudge
    int stops = 0;                         ///< times that a command was no longer justified
};

Outcome run(const Case &c);

} // namespace campaign
