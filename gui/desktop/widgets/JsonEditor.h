#pragma once

#include "gui/desktop/widgets/ValueEditor.h"

#include <QPointer>

class QPlainTextEdit;

namespace hermes::desktop {

/// A text of several lines for what no rows suit, as JSON. A value too long for that stays as it is.
class JsonEditor : public ValueEditor {
    Q_OBJECT
public:
    static constexpr int maxValues = 5000;

    explicit JsonEditor(QWidget *parent = nullptr);

    QJsonValue value() const override;
    void setValue(const QJsonValue &value) override;
    /// The value is kept, and not shown.
    void setTooLong(const QJsonValue &value);
    void addFaults(const QString &path, Faults &faults) const override;
    bool placeNote(QWidget *note) override;
    QWidgetList focusOrder() const override { return text_ ? ValueEditor::focusOrder() : QWidgetList(); }

private:
    void show(QWidget *shown);

    QPlainTextEdit *text_ = nullptr; // none: the value is too long
    QPointer<QWidget> tooLong_;
    QJsonValue given_{QJsonValue::Undefined};
    QString givenText_;
};

} // namespace hermes::desktop
