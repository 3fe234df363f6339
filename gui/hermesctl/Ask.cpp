// How commands of hermesctl ask a daemon.
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/Question.h"
#include "gui/hermesctl/Waiting.h"

#include <QElapsedTimer>
#include <QEventLoop>
#include <QPointer>
#include <QTimer>
#include <optional>

namespace hermes::ctl {
namespace {

constexpr std::chrono::hours longest{24};
constexpr std::chrono::milliseconds pause{1000}; // between questions whether the daemon still answers

} // namespace

// It takes as long as it takes, while the daemon answers other requests.
Result<QJsonValue> ask(Client &client, const Arguments &arguments, const QString &method,
                       const QJsonValue &params, Client::Repeats repeats) {
    const Waiting waiting(arguments.timeoutIsGiven ? arguments.timeout : std::chrono::milliseconds(0));
    if (arguments.timeoutIsGiven)
        return client.callAndWait(method, params, arguments.timeout, repeats);
    QElapsedTimer begun;
    begun.start();
    QEventLoop loop;
    std::optional<Result<QJsonValue>> result;
    const auto end = [&](const Result<QJsonValue> &found) {
        if (!result)
            result = found;
        loop.quit();
    };
    const QPointer<QEventLoop> guard(&loop); // answers may come later
    client.call(
        method, params,
        [&end, guard](const Result<QJsonValue> &answer) {
            if (guard)
                end(answer);
        },
        longest, repeats);
    QTimer look;
    look.setSingleShot(true);
    QObject::connect(&look, &QTimer::timeout, &loop, [&] {
        client.call(
            "daemon.info", QJsonObject(),
            [&, guard](const Result<QJsonValue> &info) {
                if (!guard || result)
                    return;
                if (info || !info.error().is(ErrorCode::TimedOut)) // whatever it answers
                    return look.start();
                end(Error(ErrorCode::TimedOut, QString("%1: no reply within %2 s")
                                                   .arg(method)
                                                   .arg(double(begun.elapsed()) / 1000, 0, 'f', 0)));
            },
            arguments.timeout - pause);
    });
    look.start(pause);
    if (!result)
        loop.exec();
    return *result;
}

Result<QJsonValue> askAgain(Client &client, const Arguments &arguments, const QString &method,
                            QJsonObject params) {
    constexpr double longest_s = 5;
    for (int waits = 0;; ++waits) {
        // Urgent: where a line damages much, a stop is not to wait for a repeat.
        const auto result = ask(client, arguments, method, params, Client::Repeats::AtOnce);
        if (result)
            return result;
        const Error &error = result.error();
        const double wait_s = error.data["retry_after_s"].toDouble();
        if (wait_s > 0 && wait_s <= longest_s && waits < 2 && !arguments.timeoutIsGiven) {
            note(QString("%1; tried again in %2 s").arg(error.message).arg(wait_s, 0, 'f', 1));
            QEventLoop pause;
            QTimer::singleShot(int(wait_s * 1000) + 1, &pause, &QEventLoop::quit);
            pause.exec();
        } else if (error.data["confirm"].toBool() && canAsk() && !params.contains("confirm")) {
            if (!isConfirmed(printable(error.message) + ". Do you confirm?"))
                return error;
            params.insert("confirm", true);
        } else {
            return error;
        }
    }
}

} // namespace hermes::ctl
