#include "common/daemon/Reply.h"
#include "protocol/wire/Fields.h"

#include <QAbstractEventDispatcher>
#include <QPointer>
#include <QThread>
#include <atomic>

namespace hermes {

class Reply::State {
public:
    explicit State(Sink receiver)
        : sink_(std::move(receiver)) {}
    ~State() { give(Error(ErrorCode::InternalError, "internal error: the command gave no answer")); }

    void give(Result<QJsonValue> answer) {
        if (given_.exchange(true))
            return;
        if (answer && answer->isUndefined()) // of asJson()
            answer = Error(ErrorCode::InternalError, "internal error: a number of the result is not finite");
        if (home_ && QThread::currentThread() != home_->thread()) {
            QMetaObject::invokeMethod(
                home_, [target = std::move(sink_), answer] { target(answer); }, Qt::QueuedConnection);
        } else {
            sink_(std::move(answer));
        }
        sink_ = nullptr;
    }

private:
    Sink sink_;
    const QPointer<QObject> home_ = QAbstractEventDispatcher::instance(); // of the thread that asked
    std::atomic<bool> given_{false};
};

Reply::Reply(Sink sink)
    : state_(std::make_shared<State>(std::move(sink))) {}

void Reply::give(Result<QJsonValue> answer) const {
    state_->give(std::move(answer));
}

} // namespace hermes
