#include "gui/vector/experiment/Algorithms.h"

#include "vectorlib/vectorization/FtlsVectorizer.h"

#include <memory>

namespace hermes {

namespace {

template <template <typename> class Vectorizer>
Algorithm make(const char *name, const char *label, const char *colour, double sigma, bool polyline) {
    const auto vectorizer = std::make_shared<Vectorizer<float>>();
    vectorizer->settings.sigma = sigma;
    vectorizer->settings.polyline = polyline;
    return {
        name, label, colour,
        [vectorizer](vectorlib::PointSpan<float> points) -> const std::vector<vectorlib::VectorizedLine> & {
            return (*vectorizer)(points);
        }};
}

} // namespace

std::vector<Algorithm> comparedAlgorithms(double sigma, bool polyline) {
    return {make<vectorlib::FtlsVectorizer>("ftls", "FTLS", "#2e9e3f", sigma, polyline)};
}

} // namespace hermes
