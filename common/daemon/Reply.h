#pragma once

#include "common/Result.h"
#include "protocol/wire/FieldsOf.h"

#include <functional>
#include <memory>

namespace hermes {

/// The answer that a handler owes. May be copied and kept for later, and be given from any thread; the first
/// answer counts. When the last copy goes without an answer the caller gets an internal error.
class Reply {
public:
    using Sink = std::function<void(Result<QJsonValue>)>;

    /// sink is called once, in the thread of the application object.
    explicit Reply(Sink sink);

    void give(Result<QJsonValue> answer) const;
    /// Answers with a struct that has fields, or with a list of such.
    template <typename T>
    void give(const Result<T> &answer) const {
        give(answer ? Result<QJsonValue>(asJson(*answer)) : Result<QJsonValue>(answer.error()));
    }
    void result(const QJsonValue &value) const { give(value); }
    void error(const Error &error) const { give(error); }

private:
    class State;
    std::shared_ptr<State> state_;
};

} // namespace hermes
