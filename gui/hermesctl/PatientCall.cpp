#include "gui/hermesctl/PatientCall.h"

#include "common/platform/Console.h"

#include <QPointer>
#include <QTimer>
#include <cstdio>

namespace hermes::ctl {
namespace {

constexpr std::chrono::hours longest{24};
constexpr std::chrono::milliseconds pause{1000}; // between questions whether the daemon still answers
constexpr qint64 shownAfter_ms = 2000;

} // namespace

Result<QJsonValue> PatientCall::run(const QString &method, const QJsonValue &params,
                                    Client::Repeats repeats) {
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
    QTimer look, clock;
    look.setSingleShot(true);
    QObject::connect(&look, &QTimer::timeout, &loop_, [this] { ask(); });
    QObject::connect(&clock, &QTimer::timeout, &loop_, [this] { show(); });
    look.start(pause);
    clock.start(pause);
    if (!result_)
        loop_.exec();
    if (isTerminal(StandardStream::Errors) && begun_.hasExpired(shownAfter_ms))
        std::fputs("\r\033[K", stderr);
    return *result_;
}

void PatientCall::ask() {
    client_.call(
        QStringLiteral("daemon.info"), QJsonObject(),
        [this, guard = QPointer<QEventLoop>(&loop_)](const Result<QJsonValue> &info) {
            if (!guard || result_)
                return;
            if (info || !info.error().is(ErrorCode::TimedOut)) // whatever it answers
                return QTimer::singleShot(pause, &loop_, [this] { ask(); });
            end(Error(ErrorCode::TimedOut, QStringLiteral("%1: no reply within %2 s")
                                               .arg(method_)
                                               .arg(double(begun_.elapsed()) / 1000, 0, 'f', 0)));
        },
        arguments_.timeout - pause);
}

void PatientCall::show() const {
    if (!isTerminal(StandardStream::Errors) || arguments_.json || !begun_.hasExpired(shownAfter_ms))
        return;
    std::fprintf(stderr, "\r\033[K%s: %lld s; Ctrl-C gives up", qPrintable(method_),
                 static_cast<long long>(begun_.elapsed() / 1000));
}

void PatientCall::end(const Result<QJsonValue> &result) {
    if (result_)
        return;
    result_ = result;
    loop_.quit();
}

} // namespace hermes::ctl
