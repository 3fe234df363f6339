#pragma once

#include "protocol/wire/WireWriter.h"

#include <QByteArray>
#include <QCborStreamWriter>

namespace hermes {

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
    void numbers(const float *values, std::size_t count) override;
    void numbers(const double *values, std::size_t count) override;
    void numbers(const quint8 *values, std::size_t count) override;
    void numbers(const quint16 *values, std::size_t count) override;

    QByteArray take() { return std::move(out_); }

protected:
    void finite(double value) override { writer_.append(value); }
    void finite(float value) override { writer_.append(value); }

private:
    template <typename T>
    void packed(int kind, const T *values, std::size_t count);

    QByteArray out_;
    QCborStreamWriter writer_{&out_};
};

} // namespace hermes
