#pragma once

#include <QJsonObject>
#include <QWidget>
#include <map>

namespace hermes::desktop {

/// What was expected in place of a wrong value, by its dotted path.
using Faults = std::map<QString, QString>;

/// What is wrong at the path or below it; the end: nothing.
Faults::const_iterator faultAt(const Faults &faults, const QString &path);
/// The path of a member or an element.
QString pathOf(const QString &parent, const QString &key);

/// The input for one value of a JSON Schema. Its own showFaults() and focusOrder() are those of a single
/// input.
class ValueEditor : public QWidget {
    Q_OBJECT
public:
    using QWidget::QWidget;

    /// Undefined: left empty. Text that is no value of the schema's type is given as a string, so that the
    /// schema refuses it.
    virtual QJsonValue value() const = 0;
    virtual void setValue(const QJsonValue &value) = 0;
    /// Adds what is wrong with the input whatever the schema's check says, as text that cannot be read.
    virtual void addFaults(const QString & /*path*/, Faults & /*faults*/) const {}
    /// Shows which of its values are wrong.
    virtual void showFaults(const QString &path, const Faults &faults);
    /// Takes a note of the value into its own lines, where it has several; false: it has one line.
    virtual bool placeNote(QWidget * /*note*/) { return false; }
    /// What takes the focus, in the order in which Tab goes.
    virtual QWidgetList focusOrder() const { return {focusProxy()}; }

protected:
    /// It consists of this one input, which has the focus.
    void hold(QWidget *input);

Q_SIGNALS:
    /// The operator changed it, by however little.
    void edited();
    /// Rows came or went.
    void rebuilt();
};

/// Tab goes from one to the next of them.
void chainFocus(const QWidgetList &order);

} // namespace hermes::desktop
