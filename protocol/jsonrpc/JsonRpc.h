#pragma once

#include "protocol/jsonrpc/RpcError.h"

#include <QJsonArray>
#include <QJsonObject>
#include <variant>
#include <vector>

namespace hermes {

/// A request, or a notification when id is undefined.
struct RpcRequest {
    QJsonValue id{QJsonValue::Undefined}; ///< string, number or null
    QString method;
    QJsonValue params{QJsonValue::Undefined}; ///< object (by name), array (by position) or undefined

    bool isNotification() const { return id.isUndefined(); }
};

/// The answer to a request: a result, or an error when failed.
struct RpcResponse {
    QJsonValue id;
    QJsonValue result;
    RpcError error;
    bool failed = false;
};

/// Something that is neither; id is that of the message where one could be read, else null.
struct RpcInvalid {
    QJsonValue id;
    RpcError error;
    QString method; ///< that it names; empty where none can be read
};

using RpcMessage = std::variant<RpcRequest, RpcResponse, RpcInvalid>;

/// What one frame held: one message, or those of a batch in order.
struct RpcFrame {
    bool batch = false;
    std::vector<RpcMessage> messages;
};

/// Reads a frame by the rules of JSON-RPC 2.0. Never fails: what breaks a rule comes as RpcInvalid (an empty
/// batch is one RpcInvalid outside a batch).
RpcFrame readFrame(const QJsonValue &frame);

QJsonObject makeRequest(const QJsonValue &id, const QString &method, const QJsonValue &params);
QJsonObject makeNotification(const QString &method, const QJsonValue &params);
QJsonObject makeResult(const QJsonValue &id, const QJsonValue &result);
QJsonObject makeError(const QJsonValue &id, const RpcError &error);

} // namespace hermes
