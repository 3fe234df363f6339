#include "common/daemon/Reply.h"
#include "protocol/wire/Fields.h"

#include <QCoreApplication>
#include <QThread>
#include <atomic>

namespace hermes {

class Reply::State {
public:
    explicit State(Sink receiver)
        : sink(std::move(receiver)) {}
    ~State() {
        give(Error(ErrorCode::InternalError, QStringLiteral("internal error: the command gave no answer")));
    }

    void give(Result<QJsonValue> answer) {
        if (given.exchange(true))
            return;
        if (answer && answer->isUndefined()) // of asJson()
            answer = Error(ErrorCode::InternalError,
                           QStringLiteral("internal error: a number of the result is not finite"));
        QCoreApplication *application = QCoreApplication::instance();
        if (application && QThread::currentThread() != application->thread()) {
            QMetaObject::invokeMethod(
                application, [target = std::move(sink), answer] { target(answer); }, Qt::QueuedConnection);
        } else {
            sink(std::move(answer));
        }
        sink = nullptr;
    }

private:
    Sink sink;
    std::atomic<bool> given{false};
};

Reply::Reply(Sink sink)
    : state(std::make_shared<State>(std::move(sink))) {}

void Reply::give(Result<QJsonValue> answer) const {
    state->give(std::move(answer));
}

} // namespace hermes
