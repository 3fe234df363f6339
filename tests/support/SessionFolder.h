#pragma once

#include "common/recording/Sidecar.h"
#include "protocol/mcap/Writer.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"
#include "tests/support/Files.h"

/// A session as the recorder leaves it, written by a test: messages at times after its beginning.
class SessionFolder {
public:
    static constexpr double start = 1.7e9; // s since the epoch

    std::map<QString, std::string> addresses; ///< of daemons, by the names that the recorder gave them

    QString path() const { return folder_.path(); }
    QString filePath(const QString &name) const { return folder_.filePath(name); }

    template <typename T>
    void add(double t_s, const QString &topic, const T &message) {
        add(t_s, topic, asText(message), hermes::compactJson(hermes::schemaOf<T>()));
    }
    void add(double t_s, const QString &topic, const QByteArray &json, const QByteArray &schema = "{}") {
        const auto key = std::pair(topic, schema);
        if (channels_.count(key) == 0)
            channels_[key] =
                writer_.addChannel(writer_.addSchema(topic.toStdString(), "jsonschema", schema.toStdString()),
                                   topic.toStdString(), "json",
                                   {{"daemon", topic.section('/', 0, 0).toStdString()},
                                    {"address", addresses[topic.section('/', 0, 0)]}});
        const auto time_ns = std::uint64_t(start * 1e9) + std::uint64_t(std::llround(t_s * 1e9));
        QVERIFY(writer_.write(
            {channels_[key], ++sequence_, time_ns, time_ns, {json.constData(), std::size_t(json.size())}}));
        last_s_ = t_s;
    }

    /// What follows comes into the next file.
    void nextFile() {
        QVERIFY(writer_.finish());
        put(folder_.filePath(QString("recorder-%1.mcap").arg(++files_, 4, 10, QChar('0'))), bytes_);
        bytes_.clear();
        channels_.clear();
        writer_ = makeWriter();
    }
    /// more: of the sidecar.
    void finish(const QJsonObject &losses = {}, const QJsonObject &more = {}) {
        nextFile();
        QJsonObject sidecar{{"format", hermes::Sidecar::format},
                            {"logger", "recorder"},
                            {"session", "7f3a"},
                            {"start", start},
                            {"end", start + last_s_},
                            {"ended", "stopped"},
                            {"complete", true},
                            {"bytes", 1000},
                            {"losses", losses}};
        for (auto member = more.begin(); member != more.end(); ++member)
            sidecar[member.key()] = *member;
        put(folder_.filePath("recorder.json"), QJsonDocument(sidecar).toJson());
    }

private:
    template <typename T>
    static QByteArray asText(const T &message) {
        return hermes::compactJson(hermes::asJson(message));
    }
    hermes::mcap::Writer makeWriter() {
        return hermes::mcap::Writer(
            [this](std::string_view bytes) {
                bytes_.append(bytes.data(), int(bytes.size()));
                return true;
            },
            "a test");
    }

    QTemporaryDir folder_;
    QByteArray bytes_;
    int files_ = 0;
    hermes::mcap::Writer writer_ = makeWriter();
    std::map<std::pair<QString, QByteArray>, std::uint16_t> channels_;
    std::uint32_t sequence_ = 0;
    double last_s_ = 0;
};
