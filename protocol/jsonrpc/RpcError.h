#pragma once

#include <QJsonValue>
#include <QString>

namespace hermes {

/// The error codes of JSON-RPC 2.0 and our own (docs/protocol.md explains each).
enum class ErrorCode {
    ParseError = -32700,
    InvalidRequest = -32600,
    MethodNotFound = -32601,
    InvalidParams = -32602,
    InternalError = -32603,
    NotAuthorised = -32001,
    ControlHeld = -32002,    ///< data.holder: who holds the control lease
    InvalidSetting = -32003, ///< data.errors: path, value, expected
    DeviceFault = -32004,
    NotReady = -32005,
    NoSuchTopic = -32006,
    OverLimit = -32007,
    InputOutput = -32008, ///< data.path: the file or device
    TimedOut = -32010,    ///< made by a client itself: no reply came in time
    Disconnected = -32011 ///< made by a client itself: the connection ended before the reply
};

/// An error as it travels: a code, a sentence for people, and optional data for programs.
struct RpcError {
    int code = int(ErrorCode::InternalError);
    QString message;
    QJsonValue data{QJsonValue::Undefined};

    RpcError() = default;
    RpcError(ErrorCode errorCode, QString text, QJsonValue details = QJsonValue(QJsonValue::Undefined))
        : code(int(errorCode))
        , message(std::move(text))
        , data(std::move(details)) {}

    bool is(ErrorCode errorCode) const { return code == int(errorCode); }
};

} // namespace hermes
