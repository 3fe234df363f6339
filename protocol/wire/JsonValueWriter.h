#pragma once

#include "protocol/wire/WireWriter.h"

#include <QJsonArray>
#include <QJsonObject>
#include <vector>

namespace hermes {

/// Writes into a QJsonValue.
class JsonValueWriter : public WireWriter {
public:
    void beginObject() override { open_.push_back({QJsonObject(), QJsonArray(), {}, true}); }
    void key(const QString &name) override { open_.back().key = name; }
    void endObject() override { close(); }
    void beginArray() override { open_.push_back({QJsonObject(), QJsonArray(), {}, false}); }
    void endArray() override { close(); }
    void null() override { put(QJsonValue::Null); }
    void boolean(bool value) override { put(value); }
    void integer(qint64 value) override { put(value); }
    void text(const QString &value) override { put(value); }

    const QJsonValue &value() const { return root_; }

protected:
    void finite(double value) override { put(value); }
    void finite(float value) override;

private:
    struct Level {
        QJsonObject object;
        QJsonArray array;
        QString key;
        bool isObject;
    };

    void put(const QJsonValue &value);
    void close();

    std::vector<Level> open_;
    QJsonValue root_{QJsonValue::Undefined};
};

} // namespace hermes
