//! The numbers are the same wherever they stand.

use super::{evidence, numbers, read};
use serde_json::Value;

/// Lines of a CSV file, cell by cell.
fn csv(text: &str) -> Vec<Vec<String>> {
    let line = |line: &str| {
        let (mut cells, mut quoted) = (vec![String::new()], false);
        for c in line.chars() {
            match c {
                '"' => quoted = !quoted,
                ',' if !quoted => cells.push(String::new()),
                c => cells.last_mut().unwrap().push(c),
            }
        }
        cells
    };
    text.lines().map(line).collect()
}

/// Cells of the tables of a page, by the name of their file.
fn tables_of_the_page(page: &str) -> Vec<(String, Vec<Vec<String>>)> {
    let between = |text: &str, start: &str, end: &str| -> Vec<String> {
        text.split(start).skip(1).filter_map(|rest| rest.split(end).next().map(str::to_string)).collect()
    };
    let unescaped =
        |text: &str| text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&");
    let cells = |row: &String| -> Vec<String> {
        between(row, "<td", "</td>").iter().map(|cell| unescaped(cell.split_once('>').unwrap().1)).collect()
    };
    let table = |piece: &str| {
        let name = between(piece, "tables/", ".csv")[0].clone();
        let body = piece.split("<tbody>").nth(1)?.split("</tbody>").next()?.to_string();
        Some((name, between(&body, "<tr>", "</tr>").iter().map(cells).collect()))
    };
    page.split("<b>Table ").skip(1).filter_map(table).collect()
}

/// Whether a text is a number to the digits that it shows.
fn shows(text: &str, number: f64) -> bool {
    let text = text.replace('−', "-");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len() as i32);
    let unit = 10_f64.powi(exponent.parse::<i32>().unwrap() - decimals);
    // Half a unit of the last digit, and rounding of the comparison itself.
    (text.parse::<f64>().unwrap() - number).abs() <= 0.5 * unit * (1.0 + 1e-9)
}

#[test]
fn numbers_in_json_are_those_of_the_tables() {
    let bench = evidence();
    let on_page = tables_of_the_page(&read(bench, "index.html"));
    let numbers = numbers(bench);
    let parts = numbers["parts"].as_object().unwrap().values();
    let tables: Vec<(&String, &Value)> = parts.flat_map(|part| part["tables"].as_object().unwrap()).collect();
    let mut compared = 0;
    for (name, table) in &tables {
        let (rows, columns) = (table["rows"].as_array().unwrap(), table["columns"].as_array().unwrap());
        let lines = csv(&read(bench, &format!("tables/{name}.csv")));
        assert_eq!(lines.len(), rows.len() + 1, "{name}");
        let page = on_page.iter().find(|(other, _)| other == *name).map(|(_, rows)| rows);
        for (i, row) in rows.iter().enumerate() {
            assert_eq!(row.as_array().unwrap().len(), columns.len(), "{name}");
            for (j, cell) in row.as_array().unwrap().iter().enumerate() {
                let (line, shown) = (&lines[i + 1][j], page.map(|page| &page[i][j]));
                let same = match cell {
                    Value::Null => line.is_empty() && shown.is_none_or(|shown| shown == "–"),
                    Value::String(text) => line == text && shown.is_none_or(|shown| shown == text),
                    number => {
                        let number = number.as_f64().unwrap();
                        compared += 1;
                        line.parse() == Ok(number) && shown.is_none_or(|shown| shows(shown, number))
                    }
                };
                assert!(same, "{name}, row {i}, column {}: {cell}, {line}, {shown:?}", columns[j]["name"]);
            }
        }
    }
    assert!(compared > 500 && on_page.len() >= 4, "{compared} numbers of {} tables", on_page.len());
}

/// Figures find their numbers by the names of columns.
#[test]
fn numbers_have_names_units_and_captions() {
    let numbers = numbers(evidence());
    for part in numbers["parts"].as_object().unwrap().values() {
        for (name, table) in part["tables"].as_object().unwrap() {
            assert!(table["caption"].as_str().unwrap().len() > 20, "{name}");
            let columns = table["columns"].as_array().unwrap();
            let names: Vec<&str> = columns.iter().map(|column| column["name"].as_str().unwrap()).collect();
            let mut unique = names.clone();
            unique.sort_unstable();
            unique.dedup();
            assert_eq!(unique.len(), names.len(), "{name}: two columns of one name in {names:?}");
        }
    }
}
