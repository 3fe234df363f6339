#include "gui/desktop/widgets/StructureEditor.h"

#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/FieldText.h"
#include "gui/desktop/widgets/JsonEditor.h"
#include "gui/desktop/widgets/ListEditor.h"
#include "gui/desktop/widgets/ObjectEditor.h"

#include <QJsonArray>

namespace hermes::desktop {
namespace {

constexpr int leastOfText = 250; // values, as which its field counts

int rowsOf(const QJsonValue &value, const QJsonObject &schema) {
    return value.isArray() ? value.toArray().size()
                           : value.toObject().size() + schema["required"].toArray().size();
}

} // namespace

StructureEditor::StructureEditor(const QJsonObject &schema, const EditorPlace &place, QWidget *parent)
    : ValueEditor(parent)
    , schema_(schema)
    , place_(place)
    , isList_(schema["type"] == "array") {
    filled(this, inColumn({}));
    setValue(schema["default"]);
}

StructureEditor::~StructureEditor() {
    giveRoomBack();
}

void StructureEditor::giveRoomBack() {
    place_.room->rows += rows_;
    place_.room->values += values_;
    rows_ = values_ = 0;
}

bool StructureEditor::suitsRows(const QJsonValue &value) const {
    const bool isKind = value.isUndefined() || (isList_ ? value.isArray() : value.isObject());
    const int rows = rowsOf(value, schema_);
    return isKind && place_.depth < deepest && rows <= ListEditor::maxRows && rows <= place_.room->rows;
}

void StructureEditor::put(ValueEditor *inner) {
    if (note_)
        note_->setParent(nullptr); // outlives the other
    delete inner_;
    inner_ = inner;
    layout()->addWidget(inner);
    setFocusProxy(inner);
    connect(inner, &ValueEditor::edited, this, &ValueEditor::edited);
    connect(inner, &ValueEditor::rebuilt, this, &ValueEditor::rebuilt);
    if (note_)
        inner->placeNote(note_);
    Q_EMIT rebuilt();
}

void StructureEditor::setValue(const QJsonValue &value) {
    giveRoomBack();
    const bool wantsRows = suitsRows(value);
    const int size = std::max(leastOfText, countValues(value, JsonEditor::maxValues));
    const bool isTooMuch = !wantsRows && size > place_.room->values;
    if (wantsRows)
        place_.room->rows -= rows_ = rowsOf(value, schema_);
    else if (!isTooMuch)
        place_.room->values -= values_ = size;
    const EditorPlace inside{place_.room, place_.depth + 1, place_.isOptional, place_.empty};
    if (!inner_ || wantsRows != hasRows_) {
        hasRows_ = wantsRows;
        if (!wantsRows)
            put(new JsonEditor);
        else if (isList_)
            put(new ListEditor(schema_, inside));
        else
            put(new ObjectEditor(schema_, inside));
    }
    if (isTooMuch)
        static_cast<JsonEditor *>(inner_)->setTooLong(value);
    else
        inner_->setValue(value);
}

bool StructureEditor::placeNote(QWidget *note) {
    note_ = note;
    return inner_->placeNote(note);
}

} // namespace hermes::desktop
