#include "gui/hermesctl/PatientCall.h"

#include "gui/hermesctl/Waiting.h"

#include <QPointer>
#include <QTimer>

namespace hermes::ctl {
namespace {

constexpr std::chrono::hours longest{24};
constexpr std::chrono::milliseconds pause{1000}; // between questions whether the daemon still answers

} // namespace

Result<QJsonValue> PatientCall::run(const QString &method, const QJsonValue &params,
                                    Client::Repeats repeats) {
    const Waiting waiting(arguments_.timeoutIsGiven ? arguments_.timeout : std::chrono::milliseconds(0));
    if (arguments_.timeoutIsGiven)
        return client_.callAndWait(method, params, arguments_.timeout, repeats);
    method_ = method;
    begun_.start();
    client_.call(
        method, params,
        [this, guard = QPointer<QEventLoop>(&loop_)](const Result<QJsonValue> &result) {
            if (guard)
                end(result);
        },
        longest, repeats);
    QTimer look;
    look.setSingleShot(true);
    QObject::connect(&look, &QTimer::timeout, &loop_, [this] { ask(); });
    look.start(pause);
    if (!result_)
        loop_.exec();
    return *result_;
}

void PatientCall::ask() {
    client_.call(
        "daemon.info", QJsonObject(),
        [this, guard = QPointer<QEventLoop>(&loop_)](const Result<QJsonValue> &info) {
            if (!guard || result_)
                return;
            if (info || !info.error().is(ErrorCode::TimedOut)) // whatever it answers
                return QTimer::singleShot(pause, &loop_, [this] { ask(); });
            end(Error(ErrorCode::TimedOut, QString("%1: no reply within %2 s")
                                               .arg(method_)
                                               .arg(double(begun_.elapsed()) / 1000, 0, 'f', 0)));
        },
        arguments_.timeout - pause);
}

void PatientCall::end(const Result<QJsonValue> &result) {
    if (result_)
        return;
    result_ = result;
    loop_.quit();
}

} // namespace hermes::ctl
