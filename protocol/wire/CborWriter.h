#pragma once

#include "protocol/wire/WireTree.h"
#include "protocol/wire/WireWriter.h"

#include <QByteArray>
#include <QCborStreamWriter>
#include <algorithm>
#include <cmath>

namespace hermes {

/// The tag of a typed array of this kind in the byte order of this machine (RFC 8746, 2.1).
constexpr quint64 typedArrayTag(PackedNumbers::Kind kind) {
    constexpr quint64 bigEndian[] = {64, 65, 66, 67, 72, 73, 74, 75, 81, 82};
    const bool hasOrder = kind != PackedNumbers::Kind::UInt8 && kind != PackedNumbers::Kind::Int8;
    return bigEndian[int(kind)] + (hasOrder && Q_BYTE_ORDER == Q_LITTLE_ENDIAN ? 4 : 0);
}

/// Writes one item of CBOR (RFC 8949); maps and arrays have an end, not a length; arrays of numbers are typed
/// arrays (RFC 8746).
class CborWriter : public WireWriter {
public:
    void beginObject() override { writer_.startMap(); }
    void key(const QString &name) override { writer_.append(name); }
    void endObject() override { writer_.endMap(); }
    void beginArray() override { writer_.startArray(); }
    void endArray() override { writer_.endArray(); }
    void null() override { writer_.appendNull(); }
    void boolean(bool value) override { writer_.append(value); }
    void integer(qint64 value) override { writer_.append(value); }
    void text(const QString &value) override { writer_.append(value); }
    void numbers(const float *values, std::size_t count) override { packed(Kind::Float, values, count); }
    void numbers(const double *values, std::size_t count) override { packed(Kind::Double, values, count); }
    void numbers(const quint8 *values, std::size_t count) override { packed(Kind::UInt8, values, count); }
    void numbers(const quint16 *values, std::size_t count) override { packed(Kind::UInt16, values, count); }

    QByteArray take() { return std::move(out_); }

protected:
    void finite(double value) override { writer_.append(value); }
    void finite(float value) override { writer_.append(value); }

private:
    using Kind = PackedNumbers::Kind;

    template <typename T>
    void packed(Kind kind, const T *values, std::size_t count) {
        if constexpr (std::is_floating_point_v<T>)
            if (!std::all_of(values, values + count, [](T value) { return std::isfinite(value); }))
                return WireWriter::numbers(values, count); // which refuses it
        writer_.append(QCborTag(typedArrayTag(kind)));
        writer_.appendByteString(reinterpret_cast<const char *>(values), qsizetype(count * sizeof(T)));
    }

    QByteArray out_;
    QCborStreamWriter writer_{&out_};
};

} // namespace hermes
