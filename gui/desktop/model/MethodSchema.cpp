#include "gui/desktop/model/MethodSchema.h"

#include <QJsonArray>

namespace hermes::desktop {

QJsonObject parametersOf(const QJsonObject &method) {
    QJsonObject properties;
    QJsonArray required;
    for (const QJsonValue &parameter : method["params"].toArray()) {
        QJsonObject schema = parameter["schema"].toObject();
        if (!schema.contains("description"))
            schema["description"] = parameter["description"].toString();
        properties[parameter["name"].toString()] = schema;
        if (parameter["required"].toBool())
            required.append(parameter["name"]);
    }
    QJsonObject schema{{"type", "object"}, {"properties", properties}};
    if (!required.isEmpty())
        schema["required"] = required;
    return schema;
}

} // namespace hermes::desktop
