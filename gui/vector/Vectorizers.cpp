#include "gui/vector/Vectorizers.h"

#include "vectorlib/vectorization/DouglasPeuckerVectorizer.h"
#include "vectorlib/vectorization/FtlsVectorizer.h"
#include "vectorlib/vectorization/IncVectorizer.h"
#include "vectorlib/vectorization/SplitAndMergeVectorizer.h"

#include <stdexcept>

namespace hermes::vector {

namespace {

using namespace vectorlib;

std::vector<NamedVectorizer> &known() {
    // A new vectorizer is one line here.
    static std::vector<NamedVectorizer> all = {
        {"tls", "one line a cluster", makeVectorizer<TlsVectorizer, double>},
        {"ftls", "as many as sigma asks for", makeVectorizer<FtlsVectorizer, double>},
        {"aftls", "ftls with the corners where they fit best", makeVectorizer<AftlsVectorizer, double>},
        {"inc", "point by point", makeVectorizer<IncVectorizer, double>},
        {"dp", "Douglas-Peucker, within 3 sigma", makeVectorizer<DouglasPeuckerVectorizer, double>},
        {"rw", "Reumann-Witkam, within 3 sigma", makeVectorizer<ReumannWitkamVectorizer, double>},
        {"rw-adjacent", "the same, its strips along adjacent points",
         makeVectorizer<AdjacentReumannWitkam, double>},
        {"sam", "split and merge, within 3 sigma", makeVectorizer<SplitAndMergeVectorizer, double>},
    };
    return all;
}

} // namespace

const std::vector<NamedVectorizer> &vectorizers() {
    return known();
}

bool addVectorizer(const NamedVectorizer &vectorizer) {
    for (const NamedVectorizer &other : known())
        if (other.name == vectorizer.name)
            throw std::invalid_argument("vectorizer " + vectorizer.name + ": there is one of that name");
    known().push_back(vectorizer);
    return true;
}

} // namespace hermes::vector
