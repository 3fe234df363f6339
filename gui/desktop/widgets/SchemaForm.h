#pragma once

#include "common/schema/SchemaValidator.h"
#include "gui/desktop/widgets/ValueEditor.h"

#include <memory>
#include <optional>

class QGridLayout;
class QLabel;

namespace hermes::desktop {

class PlainLabel;
struct EditorRoom;

/// A form for an object, made from its JSON Schema: one row a value with its title, input, unit and limits,
/// under the heading of its group. Every edit is checked against the schema at once; what is wrong stands
/// beside its input. What cannot be checked or shown here is said above; the values can be edited all the
/// same, and whoever applies them checks.
class SchemaForm : public QWidget {
    Q_OBJECT
public:
    /// More rows than this are no form; the rest is counted.
    static constexpr int maxRows = 120;

    explicit SchemaForm(QWidget *parent = nullptr);

    /// Builds the rows anew. values are what the rows show and what counts as unchanged;
    /// the defaults where there are none.
    void setSchema(const QJsonObject &schema, const QJsonObject &values);
    /// New unchanged values: rows that the operator has not touched show them.
    void setBaseline(const QJsonObject &values);
    const QJsonObject &baseline() const { return baseline_; }
    /// All rows in sight show what the schema has as default; those that the filter hides stay as they are.
    void setDefaults();
    /// Back to the unchanged values.
    void revert();

    /// Rows show these values, as if somebody had typed them.
    void edit(const QJsonObject &changes);

    /// What stands in the rows, as nested objects; rows left empty are absent.
    QJsonObject values() const;
    /// Only what differs from the unchanged values.
    QJsonObject changes() const;
    /// How many values of the changes the filter hides.
    int unseenChanges() const;
    bool isValid() const { return errors_.empty(); }
    /// Which value is wrong first, and what was expected; empty: all are valid.
    QString firstError() const;
    /// Errors that came back from the daemon: [{path, value, expected}].
    void showErrors(const QJsonArray &errors);
    /// Only rows with this text in path, title or description.
    void setFilter(const QString &text);

Q_SIGNALS:
    void edited();

protected:
    void resizeEvent(QResizeEvent *event) override;

private:
    struct Row {
        QJsonObject schema;
        PlainLabel *title, *note, *unit = nullptr;
        QLabel *description;
        ValueEditor *editor;
        std::vector<QWidget *> widgets;
        QString group;
        bool isWide;           // it has its note in its own lines
        bool isInSight = true; // for all that the filter says
    };

    void addRows(const QJsonObject &schema, const QString &prefix);
    void addRow(const QString &path, const QJsonObject &schema, bool isRequired);
    void arrange();
    void giveRoom();
    static void place(const Row &row, QGridLayout &grid, int line);
    void chainRows();
    void prepareCheck();
    void check();
    bool hasRow(const QString &path) const;
    void markAll();
    void mark(const QString &path, Row &row);

    QJsonObject schema_, baseline_;
    PlainLabel *notice_;
    QWidget *page_ = nullptr; // of the rows
    std::shared_ptr<EditorRoom> room_;
    std::optional<SchemaValidator> validator_; // none: cannot be checked
    QString hindrance_;                        // why not
    int unshown_ = 0;                          // values beyond maxRows
    std::map<QString, Row> rows_;              // by dotted path
    std::vector<QString> order_;
    std::vector<std::pair<PlainLabel *, QString>> headings_; // of the groups
    Faults errors_;
};

} // namespace hermes::desktop
