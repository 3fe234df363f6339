#pragma once

#include "gui/desktop/widgets/EditorFactory.h"

#include <vector>

class QBoxLayout;
class QGridLayout;
class QLineEdit;
class QMenu;
class QPushButton;
class QToolButton;

namespace hermes::desktop {

class PlainLabel;

/// An object as rows: its fields with title, input, unit and limits, those that may be absent only while they
/// are there; where its keys are free, each has a line for the key.
class ObjectEditor : public ValueEditor {
    Q_OBJECT
public:
    ObjectEditor(const QJsonObject &schema, const EditorPlace &place, QWidget *parent = nullptr);
    ~ObjectEditor() override;

    QJsonValue value() const override;
    void setValue(const QJsonValue &value) override;
    void addFaults(const QString &path, Faults &faults) const override;
    void showFaults(const QString &path, const Faults &faults) override;
    bool placeNote(QWidget *note) override;
    QWidgetList focusOrder() const override;

private:
    struct Row {
        QString key;
        QJsonObject schema;
        QLineEdit *freeKey = nullptr;
        ValueEditor *editor = nullptr;
        PlainLabel *note = nullptr;
        QToolButton *remove = nullptr; // none: it must be there
        QWidgetList widgets;

        QString name() const;
    };

    Row &addRow(const QString &key, const QJsonValue &value, bool isFree);
    QWidget *makeTitle(Row &row);
    void addField(const QString &key);
    void addFree();
    void remove(const Row *row);
    void clear();
    void offer();
    bool isRequired(const QString &key) const;
    Row *find(const QString &key) const;

    const QJsonObject schema_, properties_;
    const EditorPlace place_;
    bool isGiven_ = false; // also when it has no rows
    std::vector<std::unique_ptr<Row>> rows_;
    int line_ = 0; // of the grid
    QGridLayout *grid_;
    QPushButton *field_, *free_;
    QBoxLayout *foot_;
    QMenu *absent_;
};

} // namespace hermes::desktop
