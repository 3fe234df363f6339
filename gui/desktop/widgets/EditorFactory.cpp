#include "gui/desktop/widgets/EditorFactory.h"

#include "gui/desktop/widgets/CheckEditor.h"
#include "gui/desktop/widgets/ChoiceEditor.h"
#include "gui/desktop/widgets/StructureEditor.h"

namespace hermes::desktop {
namespace {

bool isNumber(const QJsonObject &schema) {
    const QString type = schema["type"].toString();
    return (type == "number" || type == "integer") && !schema["enum"].isArray();
}

} // namespace

ValueEditor *makeEditor(const QJsonObject &schema, const EditorPlace &place) {
    using Kind = LineEditor::Kind;
    const QString type = schema["type"].toString();
    const QJsonArray choices = ChoiceEditor::choicesOf(schema);
    if (type == "boolean" && !place.isOptional && !schema["enum"].isArray())
        return new CheckEditor(schema);
    if (!choices.isEmpty())
        return new ChoiceEditor(schema, choices, place.isOptional);
    if (type == "array" && isNumber(schema["items"].toObject()))
        return new LineEditor(schema, Kind::Numbers, place.empty);
    if (type == "array" || type == "object" || (type.isEmpty() && schema["properties"].isObject()))
        return new StructureEditor(schema, place);
    return new LineEditor(schema,
                          type == "string"   ? Kind::Text
                          : isNumber(schema) ? Kind::Number
                                             : Kind::Any,
                          place.empty);
}

} // namespace hermes::desktop
