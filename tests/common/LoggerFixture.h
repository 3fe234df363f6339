#pragma once

#include "common/recording/Recording.h"
#include "common/recording/Sidecar.h"

#include <mutex>

namespace hermes {

/// Writes one file of text, and fails or waits when told to.
class TextWriter : public RecordingWriter {
public:
    Result<void> begin(const RecordingPlan &plan) override {
        while (hold)
            QThread::msleep(1);
        plan_ = plan;
        file_.setFileName(plan.folder + '/' + plan.prefix + "-0001.txt");
        if (refuse || !file_.open(QIODevice::WriteOnly | QIODevice::NewOnly))
            return Error(ErrorCode::InputOutput, "refused");
        file_.write("one\ntwo\nthr");
        file_.flush();
        return {};
    }
    void end() override { file_.close(); }
    RecordingState state() const override {
        const std::lock_guard<std::mutex> lock(mutex_);
        return state_;
    }
    /// Keeps whole lines.
    Result<void> repair(const RecordingPlan &plan, QJsonObject &sidecar) override {
        QFile file(plan.folder + '/' + plan.prefix + "-0001.txt");
        if (!file.open(QIODevice::ReadWrite))
            return Error(ErrorCode::InputOutput, file.errorString());
        const QByteArray text = file.readAll();
        const int whole = text.lastIndexOf('\n') + 1;
        file.resize(whole);
        sidecar.insert("counts", QJsonObject{{"lines", text.count('\n')}});
        sidecar.insert("bytes", whole);
        sidecar.insert("end", sidecar.value("start").toDouble() + 1);
        return {};
    }
    void setState(const RecordingState &state) {
        const std::lock_guard<std::mutex> lock(mutex_);
        state_ = state;
    }

    bool refuse = false;
    std::atomic<bool> hold{false}; ///< to begin takes as long as this

private:
    RecordingPlan plan_;
    QFile file_;
    mutable std::mutex mutex_;
    RecordingState state_;
};

/// A logger without a daemon around it.
struct Logger {
    explicit Logger(const QString &root, const QString &name = "logger")
        : recording(name, settings, health, writer) {
        set("folder", root);
        set("free_floor_bytes", 0);
        set("free_warn_bytes", 0);
        recording.open();
    }
    bool set(const char *name, const QJsonValue &value) {
        return settings.set({{"record", QJsonObject{{name, value}}}}).ok();
    }
    Result<QJsonValue> call(const QString &method, const QJsonObject &params = {}) {
        Result<QJsonValue> answer = QJsonValue();
        bool answered = false;
        for (const Command &command : recording.commands())
            if (command.name() == method)
                command.execute(params, Call(), Reply([&](Result<QJsonValue> result) {
                                    answer = std::move(result);
                                    answered = true;
                                }));
        if (!QTest::qWaitFor([&] { return answered; }, 5000 * patience))
            qFatal("no answer came");
        return answer;
    }
    HealthItem item(const QString &name) {
        for (const HealthItem &item : health.list())
            if (item.name == name)
                return item;
        return {};
    }
    QString level(const QString &name) { return item(name).level; }

    Settings settings;
    Health health{nullptr};
    TextWriter writer;
    Recording recording;
};

inline QString folderOf(const Result<QJsonValue> &answer) {
    return answer->toObject().value("folder").toString();
}

inline QJsonObject sidecarOf(const QString &folder, const QString &logger = "logger") {
    const Result<QJsonObject> sidecar = Sidecar::read(Sidecar::path(folder, logger));
    return sidecar ? *sidecar : QJsonObject{{"unreadable", sidecar.error().message}};
}

} // namespace hermes
