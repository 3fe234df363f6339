#include "gui/desktop/widgets/ChoiceEditor.h"

#include "gui/desktop/widgets/FieldText.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <QComboBox>

namespace hermes::desktop {
namespace {

constexpr int longestChoice = 100;

QJsonArray alternativesOf(const QJsonObject &schema) {
    return schema["oneOf"].isArray() ? schema["oneOf"].toArray() : schema["anyOf"].toArray();
}

QString titleAt(const QJsonObject &schema, int i, const QJsonValue &value) {
    QString title = schema["enumNames"].toArray().at(i).toString();
    if (title.isEmpty())
        title = alternativesOf(schema).at(i)["title"].toString();
    if (title.isEmpty() && value.isBool())
        title = value.toBool() ? ChoiceEditor::tr("yes") : ChoiceEditor::tr("no");
    if (title.isEmpty())
        title = value.isString() ? value.toString() : jsonText(value);
    return shortLine(title, longestChoice);
}

} // namespace

QJsonArray ChoiceEditor::choicesOf(const QJsonObject &schema) {
    if (schema["enum"].isArray())
        return schema["enum"].toArray().size() <= most ? schema["enum"].toArray() : QJsonArray();
    QJsonArray constants;
    const QJsonArray alternatives = alternativesOf(schema);
    for (const QJsonValue &alternative : alternatives)
        if (alternative.toObject().contains("const") && alternatives.size() <= most)
            constants.append(alternative["const"]);
    if (!constants.isEmpty() && constants.size() == alternatives.size())
        return constants;
    return schema["type"] == "boolean" ? QJsonArray{true, false} : QJsonArray();
}

ChoiceEditor::ChoiceEditor(const QJsonObject &schema, const QJsonArray &values, bool isOptional,
                           QWidget *parent)
    : ValueEditor(parent)
    , list_(new QComboBox) {
    hold(list_);
    list_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    if (isOptional)
        list_->addItem(tr("not given"), QJsonValue(QJsonValue::Undefined));
    for (int i = 0; i < values.size(); ++i)
        list_->addItem(titleAt(schema, i, values[i]), values[i]);
    connect(list_, QOverload<int>::of(&QComboBox::activated), this, &ValueEditor::edited);
    setValue(schema["default"]);
}

QJsonValue ChoiceEditor::value() const {
    return list_->currentIndex() < 0 ? other_ : list_->currentData().toJsonValue();
}

void ChoiceEditor::setValue(const QJsonValue &value) {
    other_ = value;
    int found = -1;
    for (int i = 0; i < list_->count() && found < 0; ++i)
        if (list_->itemData(i).toJsonValue() == value)
            found = i;
    list_->setCurrentIndex(found);
}

} // namespace hermes::desktop
