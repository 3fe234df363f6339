#include "protocol/jsonrpc/JsonRpc.h"

#include <cmath>

namespace hermes {
namespace {

const QString versionKey = QStringLiteral("jsonrpc");
const QString version = QStringLiteral("2.0");
const QString idKey = QStringLiteral("id");
const QString methodKey = QStringLiteral("method");
const QString paramsKey = QStringLiteral("params");
const QString resultKey = QStringLiteral("result");
const QString errorKey = QStringLiteral("error");

// Beyond it the reply would have another one.
constexpr double largestId = 9007199254740991.0;

bool isId(const QJsonValue &value) {
    return value.isString() || value.isNull() ||
           (value.isDouble() && std::abs(value.toDouble()) <= largestId);
}

RpcInvalid invalid(const QJsonValue &id, const QString &why) {
    return {isId(id) ? id : QJsonValue(),
            RpcError(ErrorCode::InvalidRequest, QStringLiteral("invalid request: ") + why),
            {}};
}

RpcMessage readRequest(const QJsonObject &object, const QJsonValue &id) {
    const QJsonValue method = object.value(methodKey);
    const QJsonValue params = object.value(paramsKey);
    if (!method.isString())
        return invalid(id, QStringLiteral("\"method\" must be a string"));
    if (!params.isUndefined() && !params.isObject() && !params.isArray())
        return invalid(id, QStringLiteral("\"params\" must be an object or an array"));
    return RpcRequest{id, method.toString(), params};
}

RpcMessage readResponse(const QJsonObject &object, const QJsonValue &id) {
    if (id.isUndefined())
        return invalid(id, QStringLiteral("a response needs an \"id\""));
    RpcResponse response{id, object.value(resultKey), {}, object.contains(errorKey)};
    if (response.failed == object.contains(resultKey))
        return invalid(id, QStringLiteral("a response has either \"result\" or \"error\""));
    if (response.failed) {
        const QJsonObject error = object.value(errorKey).toObject();
        if (!error.value(QStringLiteral("code")).isDouble() ||
            !error.value(QStringLiteral("message")).isString())
            return invalid(id, QStringLiteral("\"error\" needs a number \"code\" and a string \"message\""));
        response.error.code = error.value(QStringLiteral("code")).toInt();
        response.error.message = error.value(QStringLiteral("message")).toString();
        response.error.data = error.value(QStringLiteral("data"));
    }
    return response;
}

RpcMessage readWhole(const QJsonValue &value) {
    if (!value.isObject())
        return invalid(QJsonValue(), QStringLiteral("a message is a JSON object"));
    const QJsonObject object = value.toObject();
    const QJsonValue id = object.value(idKey);
    if (!id.isUndefined() && !isId(id))
        return invalid(
            id, QStringLiteral("\"id\" must be a string, null, or a number from -(2^53 - 1) to 2^53 - 1"));
    if (object.value(versionKey) != version)
        return invalid(id, QStringLiteral("\"jsonrpc\" must be \"2.0\""));
    if (object.contains(methodKey))
        return readRequest(object, id);
    if (object.contains(resultKey) || object.contains(errorKey))
        return readResponse(object, id);
    return invalid(id, QStringLiteral("\"method\" is missing"));
}

RpcMessage readMessage(const QJsonValue &value) {
    RpcMessage message = readWhole(value);
    if (auto *wrong = std::get_if<RpcInvalid>(&message))
        wrong->method = value.toObject().value(methodKey).toString();
    return message;
}

} // namespace

RpcFrame readFrame(const QJsonValue &frame) {
    if (!frame.isArray())
        return {false, {readMessage(frame)}};
    const QJsonArray array = frame.toArray();
    if (array.isEmpty())
        return {false, {invalid(QJsonValue(), QStringLiteral("the batch is empty"))}};
    RpcFrame result{true, {}};
    for (const QJsonValue &value : array)
        result.messages.push_back(readMessage(value));
    return result;
}

QJsonObject makeRequest(const QJsonValue &id, const QString &method, const QJsonValue &params) {
    QJsonObject object = makeNotification(method, params);
    object.insert(idKey, id);
    return object;
}

QJsonObject makeNotification(const QString &method, const QJsonValue &params) {
    QJsonObject object{{versionKey, version}, {methodKey, method}};
    if (!params.isUndefined())
        object.insert(paramsKey, params);
    return object;
}

QJsonObject makeResult(const QJsonValue &id, const QJsonValue &result) {
    return {{versionKey, version}, {idKey, id}, {resultKey, result.isUndefined() ? QJsonValue() : result}};
}

QJsonObject makeError(const QJsonValue &id, const RpcError &error) {
    QJsonObject body{{QStringLiteral("code"), error.code}, {QStringLiteral("message"), error.message}};
    if (!error.data.isUndefined())
        body.insert(QStringLiteral("data"), error.data);
    return {{versionKey, version}, {idKey, id}, {errorKey, body}};
}

} // namespace hermes
