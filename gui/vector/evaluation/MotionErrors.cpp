#include "gui/vector/evaluation/MotionErrors.h"

#include "gui/vector/Quantile.h"

#include <numeric>

namespace hermes::vector {

namespace {

using Json = nlohmann::ordered_json;

void addSummary(Json &json, const std::string &unit, const std::vector<double> &values) {
    const bool any = !values.empty();
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    json["mean_" + unit] = any ? Json(sum / double(values.size())) : Json();
    json["median_" + unit] = any ? Json(quantile(values, 0.5)) : Json();
    json["percentile_95_" + unit] = any ? Json(quantile(values, 0.95)) : Json();
}

} // namespace

Json MotionErrors::summary() const {
    constexpr double nearMetres = 0.10, nearDegrees = 2;
    Json json;
    addSummary(json, "m", metres_);
    addSummary(json, "deg", degrees_);
    std::size_t near = 0;
    for (std::size_t i = 0; i < size(); ++i)
        near += metres_[i] <= nearMetres && degrees_[i] <= nearDegrees;
    json["within_10cm_2deg"] = size() > 0 ? Json(double(near) / double(size())) : Json();
    return json;
}

} // namespace hermes::vector
