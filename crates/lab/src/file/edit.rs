//! A file with values put into its text, comments and order kept.

use toml_edit::{DocumentMut, Item, Table, Value};

/// The text with values put over its own, by path; a value is written as TOML.
///
/// # Errors
/// A sentence where a path leads through something that is no table, or a value is not TOML.
pub fn with_values(text: &str, sets: &[(String, String)]) -> Result<String, String> {
    let mut document: DocumentMut = text.parse().map_err(|error| format!("not TOML: {error}"))?;
    for (path, value) in sets {
        let value: Value = value.parse().map_err(|error| format!("`{path}`: not a value: {error}"))?;
        let parts: Vec<&str> = path.split('.').collect();
        put(document.as_item_mut(), &parts, value).map_err(|what| format!("`{path}`: {what}"))?;
    }
    Ok(document.to_string())
}

fn put(at: &mut Item, parts: &[&str], value: Value) -> Result<(), String> {
    let Some((first, rest)) = parts.split_first() else {
        let decor = at.as_value().map(|old| old.decor().clone());
        let mut value = value;
        if let Some(decor) = decor {
            // what stands around a value, as a comment behind it, stays
            *value.decor_mut() = decor;
        }
        *at = Item::Value(value);
        return Ok(());
    };
    if let Some(list) = at.as_array_of_tables_mut() {
        let table = first.parse().ok().and_then(|k: usize| list.get_mut(k)).ok_or("no such entry")?;
        let Some((key, below)) = rest.split_first() else { return Err("an entry is a table".into()) };
        return put(table.entry(key).or_insert(Item::None), below, value);
    }
    if let Some(list) = at.as_array_mut() {
        let entry = first.parse().ok().and_then(|k: usize| list.get_mut(k)).ok_or("no such entry")?;
        let mut item = Item::Value(entry.clone());
        put(&mut item, rest, value)?;
        *entry = item.into_value().map_err(|_| "an entry is a value".to_owned())?;
        return Ok(());
    }
    // a choice may be written as a word, which stands for a table with that key
    if at.as_str() == Some(first) {
        let mut table = toml_edit::InlineTable::new();
        table.insert(*first, Value::InlineTable(toml_edit::InlineTable::new()));
        *at = Item::Value(Value::InlineTable(table));
    }
    if at.is_none() {
        *at = Item::Table(Table::new());
    }
    let inline = at.is_inline_table();
    let table = at.as_table_like_mut().ok_or_else(|| format!("`{first}` would lie below what is no table"))?;
    if !table.contains_key(first) {
        let empty = if rest.is_empty() {
            Item::None
        } else if inline {
            Item::Value(Value::InlineTable(toml_edit::InlineTable::new()))
        } else {
            Item::Table(Table::new())
        };
        if rest.is_empty() {
            table.insert(first, Item::Value(value));
            return Ok(());
        }
        table.insert(first, empty);
    }
    if rest.is_empty() {
        let above = table.get(first).and_then(above);
        if let (Some(above), Some(mut key)) = (above, table.key_mut(first)) {
            key.fmt();
            key.leaf_decor_mut().set_prefix(above);
        }
    }
    let below = table.get_mut(first).ok_or("no such key")?;
    put(below, rest, value)
}

/// What stands above a section, comments for one: where the section becomes a line, it stays above that.
fn above(item: &Item) -> Option<String> {
    let table = match item {
        Item::Table(table) => table,
        Item::ArrayOfTables(list) => list.get(0)?,
        Item::None | Item::Value(_) => return None,
    };
    Some(table.decor().prefix().and_then(|above| above.as_str()).unwrap_or_default().to_owned())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn values_are_put_and_comments_stay() {
        let text = "# head\na = 1 # one\n[b]\nc = { d = 2 }\nword = \"x\"\n[[list]]\ne = 3\n";
        let set = |path: &str, value: &str| with_values(text, &[(path.into(), value.into())]).unwrap();
        assert_eq!(set("a", "5"), text.replace("a = 1 # one", "a = 5 # one"));
        assert!(set("b.c.d", "7").contains("c = { d = 7 }"));
        assert!(set("b.c.new", "true").contains("new = true"));
        assert!(set("b.word.x.deep", "\"y\"").contains("word = { x = { deep = \"y\" } }"));
        assert!(set("list.0.e", "4").contains("e = 4"));
        assert!(set("fresh.deep.er", "1").contains("er = 1"));
        let whole = with_values("a = 1\n\n# why\n[b]\nc = 2\n", &[("b".into(), "{ d = 3 }".into())]).unwrap();
        assert_eq!(
            whole, "a = 1\n\n# why\nb = { d = 3 }\n",
            "a section that becomes a line keeps what stands above it"
        );
        assert!(with_values(text, &[("a.b".into(), "1".into())]).unwrap_err().contains("no table"));
        assert!(with_values(text, &[("a".into(), "{".into())]).is_err());
    }
}
