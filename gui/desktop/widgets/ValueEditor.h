#pragma once

#include <QJsonObject>
#include <QWidget>

class QCheckBox;
class QComboBox;
class QLineEdit;

namespace hermes::desktop {

/// The input for one value of a JSON Schema: a check box, a choice, or a line of text. Numbers go up and down
/// by their step with the arrow keys; arrays and objects are written as JSON. A value too long for a line
/// stays as it is.
class ValueEditor : public QWidget {
    Q_OBJECT
public:
    explicit ValueEditor(const QJsonObject &schema, QWidget *parent = nullptr);

    /// Undefined: left empty. Text that is no value of the schema's type is given as a string, so that the
    /// schema refuses it.
    QJsonValue value() const;
    void setValue(const QJsonValue &value);
    /// Shows that the value is wrong.
    void setWrong(bool isWrong);

Q_SIGNALS:
    /// The operator changed it, by however little.
    void edited();

protected:
    bool eventFilter(QObject *watched, QEvent *event) override;

private:
    void step(int count);
    void choose(const QJsonValue &value);
    void showText(const QJsonValue &value);

    const QJsonObject schema_;
    const QString type_;
    QCheckBox *check_ = nullptr;
    QComboBox *choice_ = nullptr;
    QLineEdit *text_ = nullptr;
    QJsonValue longValue_{QJsonValue::Undefined}; // not editable here
};

} // namespace hermes::desktop
