#pragma once

#include "protocol/wire/WireWriter.h"

#include <QByteArray>

namespace hermes {

/// Writes compact JSON, UTF-8, on one line; members in the order in which they come.
class JsonTextWriter : public WireWriter {
public:
    void beginObject() override { separate('{'); }
    void key(const QString &name) override;
    void endObject() override { out_.append('}'); }
    void beginArray() override { separate('['); }
    void endArray() override { out_.append(']'); }
    void null() override;
    void boolean(bool value) override;
    void integer(qint64 value) override;
    void text(const QString &value) override;

    const QByteArray &bytes() const { return out_; }
    QByteArray take() { return std::move(out_); }

protected:
    void finite(double value) override;
    void finite(float value) override;

private:
    void separate();
    void separate(char next);
    void quote(const QString &text);
    template <typename T>
    void digits(T value);

    QByteArray out_;
};

} // namespace hermes
