//! A memory of limited size.

use std::collections::HashMap;
use std::hash::Hash;

/// Keeps the values that were asked for last. Those it lets go live on with their users.
#[derive(Debug)]
pub(super) struct Cache<K, V> {
    entries: HashMap<K, Entry<V>>,
    most: usize,
    requests: u64,
}

#[derive(Debug)]
struct Entry<V> {
    value: V,
    /// The number of the request that asked for it last.
    asked: u64,
}

impl<K: Clone + Eq + Hash, V: Clone> Cache<K, V> {
    /// Of at most that many values.
    pub(super) fn new(most: usize) -> Self {
        Self { entries: HashMap::new(), most, requests: 0 }
    }

    /// The value of a key.
    pub(super) fn get(&mut self, key: &K) -> Option<V> {
        self.requests += 1;
        let entry = self.entries.get_mut(key)?;
        entry.asked = self.requests;
        Some(entry.value.clone())
    }

    /// Keeps a value, and lets go of the one that was not asked for the longest where there is no place.
    pub(super) fn insert(&mut self, key: K, value: V) {
        let full = self.entries.len() >= self.most && !self.entries.contains_key(&key);
        if let Some(oldest) = self.entries.iter().filter(|_| full).min_by_key(|(_, entry)| entry.asked) {
            let oldest = oldest.0.clone();
            self.entries.remove(&oldest);
        }
        self.requests += 1;
        self.entries.insert(key, Entry { value, asked: self.requests });
    }
}

#[cfg(test)]
mod tests {
    use super::Cache;

    #[test]
    fn what_was_asked_for_last_is_kept() {
        let mut cache = Cache::new(2);
        cache.insert("a", 1);
        cache.insert("b", 2);
        assert_eq!(cache.get(&"a"), Some(1));
        cache.insert("c", 3);
        assert_eq!([cache.get(&"a"), cache.get(&"b"), cache.get(&"c")], [Some(1), None, Some(3)]);
        cache.insert("a", 4);
        assert_eq!([cache.get(&"a"), cache.get(&"c")], [Some(4), Some(3)], "a key that is there takes no place");
    }
}
