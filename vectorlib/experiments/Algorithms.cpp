#include "vectorlib/experiments/Algorithms.h"

#include "vectorlib/vectorization/DouglasPeuckerVectorizer.h"
#include "vectorlib/vectorization/FtlsVectorizer.h"
#include "vectorlib/vectorization/IncVectorizer.h"
#include "vectorlib/vectorization/SplitAndMergeVectorizer.h"

namespace hermes::experiments {

using vector::AdjacentReumannWitkam;
using vector::makeVectorizer;
using vector::NelderMeadAftls;

namespace {

template <template <typename> class Vectorizer>
Algorithm make(const char *name, const char *label, const char *colour, double sigma, bool polyline) {
    return {name, label, colour,
            makeVectorizer<Vectorizer, float>({sigma, 5 * sigma, polyline})}; // as by default
}

} // namespace

std::vector<Algorithm> comparedAlgorithms(double sigma, bool polyline) {
    return {make<vectorlib::AftlsVectorizer>("aftls", "AFTLS", "#7ed957", sigma, polyline),
            make<vectorlib::FtlsVectorizer>("ftls", "FTLS", "#2e9e3f", sigma, polyline),
            make<vectorlib::IncVectorizer>("inc", "INC", "#0b5d1e", sigma, polyline),
            make<vectorlib::DouglasPeuckerVectorizer>("dp", "DP", "#000000", sigma, polyline),
            make<vectorlib::ReumannWitkamVectorizer>("rw", "RW", "#9a9a9a", sigma, polyline),
            make<vectorlib::SplitAndMergeVectorizer>("sam", "SAM", "#0072b2", sigma, polyline)};
}

std::vector<Algorithm> sceneAlgorithms(double sigma) {
    std::vector<Algorithm> all = comparedAlgorithms(sigma, true);
    all.push_back(make<NelderMeadAftls>("aftls", "AFTLS-NM", "#e69f00", sigma, true));
    all.push_back(make<AdjacentReumannWitkam>("rw-adjacent", "RW-adjacent", "#cc79a7", sigma, true));
    return all;
}

std::vector<Algorithm> polylineExtractors(double sigma) {
    std::vector<Algorithm> all = comparedAlgorithms(sigma, true);
    all.back().label = "SAM+";
    all.push_back(make<vectorlib::SplitAndMergeVectorizer>("sam", "SAM", "#56b4e9", sigma, false));
    return all;
}

} // namespace hermes::experiments
