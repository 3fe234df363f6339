#pragma once

#include "common/client/Client.h"
#include "gui/hermesctl/Arguments.h"

#include <QElapsedTimer>
#include <QEventLoop>
#include <optional>

namespace hermes::ctl {

/// A call that takes as long as it takes: it waits while the daemon answers other requests. At a terminal
/// stderr shows how long it has waited. With --timeout it waits so long and no longer.
class PatientCall {
public:
    PatientCall(Client &client, const Arguments &arguments)
        : client_(client)
        , arguments_(arguments) {}

    /// Error also: the daemon has answered nothing at all for the time-out.
    Result<QJsonValue> run(const QString &method, const QJsonValue &params, Client::Repeats repeats);

private:
    void ask();
    void end(const Result<QJsonValue> &result);

    Client &client_;
    const Arguments &arguments_;
    QString method_;
    QEventLoop loop_;
    QElapsedTimer begun_;
    std::optional<Result<QJsonValue>> result_;
};

} // namespace hermes::ctl
