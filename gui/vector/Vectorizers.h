#pragma once

#include "vectorlib/vectorization/AftlsVectorizer.h"
#include "vectorlib/vectorization/ReumannWitkamVectorizer.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace hermes::vector {

/// A vectorizer at work: the lines of a cluster, which stand until it is called again.
template <typename Scalar>
using Vectorize = std::function<const std::vector<vectorlib::VectorizedLine> &(vectorlib::PointSpan<Scalar>)>;

/// One of the vectorizers, chosen at run time by its name.
struct NamedVectorizer {
    std::string name; ///< as the option --algorithm takes it
    std::string help; ///< what it does, in a few words
    std::function<Vectorize<double>(const vectorlib::VectorizerSettings &)> make;
};

/// All that are known, in the order in which they are told.
const std::vector<NamedVectorizer> &vectorizers();
/// Makes one known before main() begins, as the initializer of a global constant; see makeVectorizer() for
/// what it needs. Throws std::invalid_argument when its name is another's. Gives true.
bool addVectorizer(const NamedVectorizer &vectorizer);

/// A vectorizer of the library's kind: settings that begin with VectorizerSettings, and an operator() as that
/// of TlsVectorizer.
template <template <typename> class Vectorizer, typename Scalar>
Vectorize<Scalar> makeVectorizer(const vectorlib::VectorizerSettings &settings) {
    const auto vectorizer = std::make_shared<Vectorizer<Scalar>>();
    static_cast<vectorlib::VectorizerSettings &>(vectorizer->settings) = settings;
    return
        [vectorizer](vectorlib::PointSpan<Scalar> points) -> const std::vector<vectorlib::VectorizedLine> & {
            return (*vectorizer)(points);
        };
}

/// AFTLS whose break points are sought as published, by Nelder and Mead's method (thesis 6.4).
template <typename Scalar>
struct NelderMeadAftls : vectorlib::AftlsVectorizer<Scalar> {
    NelderMeadAftls() { this->search = vectorlib::AftlsVectorizer<Scalar>::Search::NelderMead; }
};

/// Reumann-Witkam with strips along adjacent points.
template <typename Scalar>
struct AdjacentReumannWitkam : vectorlib::ReumannWitkamVectorizer<Scalar> {
    AdjacentReumannWitkam() {
        this->direction = vectorlib::ReumannWitkamVectorizer<Scalar>::Direction::NextPoint;
    }
};

} // namespace hermes::vector
