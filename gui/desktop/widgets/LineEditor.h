#pragma once

#include "gui/desktop/widgets/ValueEditor.h"

class QLineEdit;

namespace hermes::desktop {

/// A line for a text, a number, a list of numbers ("1, 2.5, 3"), or any value (a word, a number, or JSON).
/// Numbers go up and down by their step with the arrow keys, by ten with PageUp and PageDown. What nobody has
/// changed comes out as it went in, with all its digits. A value too long for a line stays as it is.
class LineEditor : public ValueEditor {
    Q_OBJECT
public:
    enum class Kind { Text, Number, Numbers, Any };
    /// What a line without text means.
    enum class Empty { Absent, Text };

    LineEditor(const QJsonObject &schema, Kind kind, Empty empty, QWidget *parent = nullptr);

    QJsonValue value() const override;
    void setValue(const QJsonValue &value) override;
    void addFaults(const QString &path, Faults &faults) const override;

protected:
    bool eventFilter(QObject *watched, QEvent *event) override;

private:
    QJsonValue typed() const;
    QString textOf(const QJsonValue &value) const;
    void step(int count);

    const QJsonObject schema_;
    const Kind kind_;
    const Empty empty_;
    QLineEdit *line_;
    QJsonValue given_{QJsonValue::Undefined}; // by setValue()
    QString givenText_;                       // as which it was shown
};

} // namespace hermes::desktop
