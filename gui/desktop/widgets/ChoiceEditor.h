#pragma once

#include "gui/desktop/widgets/ValueEditor.h"

#include <QJsonArray>

class QComboBox;

namespace hermes::desktop {

/// A list of the values that are allowed, with their titles; for what may be absent also "not given". A value
/// that is none of them is kept until another is chosen.
class ChoiceEditor : public ValueEditor {
    Q_OBJECT
public:
    static constexpr int most = 1000;

    ChoiceEditor(const QJsonObject &schema, const QJsonArray &values, bool isOptional,
                 QWidget *parent = nullptr);
    /// What may be chosen: of `enum`, of alternatives that are one constant each, yes and no of a boolean;
    /// empty: it is no choice.
    static QJsonArray choicesOf(const QJsonObject &schema);

    QJsonValue value() const override;
    void setValue(const QJsonValue &value) override;

private:
    QComboBox *list_;
    QJsonValue other_{QJsonValue::Undefined}; // that cannot be chosen
};

} // namespace hermes::desktop
