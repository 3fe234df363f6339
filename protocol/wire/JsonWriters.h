#pragma once

#include "protocol/wire/WireWriter.h"

#include <QByteArray>
#include <QJsonArray>
#include <QJsonObject>

#include <charconv>
#include <vector>

namespace hermes {

/// Writes compact JSON, UTF-8, on one line; members in the order in which they come.
class JsonTextWriter : public WireWriter {
public:
    void beginObject() override { separate('{'); }
    void key(const QString &name) override {
        separate();
        quote(name);
        out_.append(':');
    }
    void endObject() override { out_.append('}'); }
    void beginArray() override { separate('['); }
    void endArray() override { out_.append(']'); }
    void null() override {
        separate();
        out_.append("null");
    }
    void boolean(bool value) override {
        separate();
        out_.append(value ? "true" : "false");
    }
    void integer(qint64 value) override { digits(value); }
    void text(const QString &value) override {
        separate();
        quote(value);
    }

    const QByteArray &bytes() const { return out_; }
    QByteArray take() { return std::move(out_); }

protected:
    void finite(double value) override { digits(value); }
    void finite(float value) override { digits(value); }

private:
    void separate();
    void separate(char next);
    void quote(const QString &text);
    template <typename T>
    void digits(T value) {
        separate();
        char buffer[32];
        out_.append(buffer, int(std::to_chars(buffer, buffer + sizeof buffer, value).ptr - buffer));
    }

    QByteArray out_;
};

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
    void close() {
        const Level level = std::move(open_.back());
        open_.pop_back();
        put(level.isObject ? QJsonValue(level.object) : QJsonValue(level.array));
    }

    std::vector<Level> open_;
    QJsonValue root_{QJsonValue::Undefined};
};

} // namespace hermes
