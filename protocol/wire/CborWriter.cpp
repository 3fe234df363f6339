#include "protocol/wire/CborWriter.h"

#include "protocol/wire/CborTags.h"

#include <algorithm>
#include <cmath>

namespace hermes {

using Kind = PackedNumbers::Kind;

template <typename T>
void CborWriter::packed(int kind, const T *values, std::size_t count) {
    if constexpr (std::is_floating_point_v<T>)
        if (!std::all_of(values, values + count, [](T value) { return std::isfinite(value); }))
            return WireWriter::numbers(values, count); // which refuses it
    writer_.append(QCborTag(typedArrayTag(Kind(kind))));
    writer_.appendByteString(reinterpret_cast<const char *>(values), qsizetype(count * sizeof(T)));
}

void CborWriter::numbers(const float *values, std::size_t count) {
    packed(int(Kind::Float), values, count);
}

void CborWriter::numbers(const double *values, std::size_t count) {
    packed(int(Kind::Double), values, count);
}

void CborWriter::numbers(const quint8 *values, std::size_t count) {
    packed(int(Kind::UInt8), values, count);
}

void CborWriter::numbers(const quint16 *values, std::size_t count) {
    packed(int(Kind::UInt16), values, count);
}

} // namespace hermes
