//! The tables of a file: objects, their attributes and values.

use std::collections::HashMap;

use super::coding;
use super::value::{Rep, Type, Value};

/// What a path is, with its number in the format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Kind {
    Attribute = 1,
    Prim = 6,
    Root = 7,
    Relationship = 8,
}

/// The object or attribute of a path.
#[derive(Debug)]
struct Node {
    /// The last part of its path; a negative number marks an attribute in the file.
    name: u32,
    is_property: bool,
    children: Vec<usize>,
    kind: Option<Kind>,
    fields: Vec<(u32, Rep)>,
}

/// A file under construction. Paths are written as `/object/part.attribute`.
#[derive(Debug)]
pub(super) struct Layer {
    /// The offset of the first of `values` in the file.
    base: u64,
    values: Vec<u8>,
    tokens: Interner<String>,
    strings: Interner<u32>,
    paths: HashMap<String, usize>,
    nodes: Vec<Node>,
}

/// The end of a file.
#[derive(Debug)]
pub(super) struct Tail {
    pub(super) bytes: Vec<u8>,
    /// The offset of the table of contents in the file.
    pub(super) contents: u64,
}

/// Numbers of distinct values.
#[derive(Debug)]
struct Interner<T> {
    list: Vec<T>,
    numbers: HashMap<T, u32>,
}

impl<T: Clone + Eq + std::hash::Hash> Interner<T> {
    fn new() -> Self {
        Self { list: Vec::new(), numbers: HashMap::new() }
    }

    fn number(&mut self, value: T) -> u32 {
        let next = self.list.len() as u32;
        let number = *self.numbers.entry(value.clone()).or_insert(next);
        if number == next {
            self.list.push(value);
        }
        number
    }
}

impl Layer {
    /// Without objects. Values are stored at the offset `base` of the file, a multiple of 8.
    pub(super) fn new(base: u64) -> Self {
        let mut tokens = Interner::new();
        // Number 0 has no sign, so it must not be the name of an attribute.
        tokens.number(String::new());
        let root = Node { name: 0, is_property: false, children: Vec::new(), kind: None, fields: Vec::new() };
        Self {
            base,
            values: Vec::new(),
            tokens,
            strings: Interner::new(),
            paths: HashMap::from([("/".to_owned(), 0)]),
            nodes: vec![root],
        }
    }

    /// Adds what a path names, with its fields.
    pub(super) fn add(&mut self, path: &str, kind: Kind, fields: Vec<(&str, Value)>) {
        let fields: Vec<(u32, Rep)> =
            fields.into_iter().map(|(name, value)| (self.token(name), self.rep(value))).collect();
        let node = self.node(path);
        self.nodes[node].kind = Some(kind);
        self.nodes[node].fields = fields;
    }

    /// The number of a path, which is added if it is new.
    fn node(&mut self, path: &str) -> usize {
        if let Some(&node) = self.paths.get(path) {
            return node;
        }
        let split = path.rfind(['/', '.']).unwrap_or(0);
        let is_property = path[split..].starts_with('.');
        let parent = self.node(if split == 0 { "/" } else { &path[..split] });
        let name = self.token(&path[split + 1..]);
        let node = self.nodes.len();
        self.nodes.push(Node { name, is_property, children: Vec::new(), kind: None, fields: Vec::new() });
        self.nodes[parent].children.push(node);
        self.paths.insert(path.to_owned(), node);
        node
    }

    fn token(&mut self, word: &str) -> u32 {
        self.tokens.number(word.to_owned())
    }

    /// Stores bytes at a multiple of 8; returns their offset in the file.
    fn store(&mut self, bytes: &[u8]) -> u64 {
        self.values.resize(self.values.len().next_multiple_of(8), 0);
        let offset = self.base + self.values.len() as u64;
        self.values.extend_from_slice(bytes);
        offset
    }

    /// Stores numbers after their count.
    fn store_list(&mut self, count: usize, elements: &[u8]) -> u64 {
        self.store(&[&(count as u64).to_le_bytes()[..], elements].concat())
    }

    /// Stores a value, if it does not fit into its representation.
    pub(super) fn rep(&mut self, value: Value) -> Rep {
        match value {
            Value::Bool(value) => Rep::inlined(Type::Bool, value.into()),
            Value::Float(value) => Rep::inlined(Type::Float, value.to_bits()),
            Value::Double(value) => Rep::at(Type::Double, self.store(&value.to_le_bytes())),
            Value::Token(word) => Rep::inlined(Type::Token, self.token(&word)),
            Value::String(text) => {
                let token = self.token(&text);
                Rep::inlined(Type::String, self.strings.number(token))
            }
            Value::Word(kind, value) => Rep::inlined(kind, value),
            Value::Float2(v) => Rep::at(Type::Vec2f, self.store(bytemuck::cast_slice(&v))),
            Value::Float3(v) => Rep::at(Type::Vec3f, self.store(bytemuck::cast_slice(&v))),
            Value::Quaternion(q) => Rep::at(Type::Quatf, self.store(bytemuck::cast_slice(&q))),
            Value::Floats(list) => {
                Rep::array(Type::Float, self.store_list(list.len(), bytemuck::cast_slice(&list)))
            }
            Value::Vectors(list) => {
                Rep::array(Type::Vec3f, self.store_list(list.len(), bytemuck::cast_slice(&list)))
            }
            Value::Integers(list) => self.integers(&list),
            Value::Threes(count) if count < coding::SHORTEST => self.integers(&vec![3; count]),
            Value::Threes(count) => {
                let bytes = coding::compressed(&coding::repeated(3, count));
                Rep::compressed(Type::Int, self.store_list(count, &bytes))
            }
            Value::Tokens(list) => Rep::array(Type::Token, self.store_tokens(&list)),
            Value::Names(list) => Rep::at(Type::TokenVector, self.store_tokens(&list)),
            Value::Prepended(list) => {
                let numbers: Vec<u32> = list.iter().map(|word| self.token(word)).collect();
                Rep::at(Type::TokenListOp, self.store_changes(PREPENDED, &numbers))
            }
            Value::Targets(list) => {
                let numbers: Vec<u32> = list.iter().map(|path| self.node(path) as u32).collect();
                Rep::at(Type::PathListOp, self.store_changes(EXPLICIT, &numbers))
            }
            Value::Samples(samples) => self.samples(&samples),
        }
    }

    fn store_tokens(&mut self, list: &[String]) -> u64 {
        let numbers: Vec<u32> = list.iter().map(|word| self.token(word)).collect();
        self.store_list(numbers.len(), bytemuck::cast_slice(&numbers))
    }

    /// A change of a list: what kind of change, and the items.
    fn store_changes(&mut self, change: u8, items: &[u32]) -> u64 {
        let count = (items.len() as u64).to_le_bytes();
        self.store(&[&[change][..], &count, bytemuck::cast_slice(items)].concat())
    }

    fn integers(&mut self, list: &[i32]) -> Rep {
        if list.is_empty() {
            return Rep::array(Type::Int, 0);
        }
        if list.len() < coding::SHORTEST {
            return Rep::array(Type::Int, self.store_list(list.len(), bytemuck::cast_slice(list)));
        }
        let bytes = coding::compressed(&coding::integers(list));
        Rep::compressed(Type::Int, self.store_list(list.len(), &bytes))
    }

    /// Two parts, each preceded by the distance to its representations: the times and the values.
    fn samples(&mut self, samples: &[(f64, Rep)]) -> Rep {
        let times: Vec<f64> = samples.iter().map(|(time, _)| *time).collect();
        let times = Rep::at(Type::DoubleVector, self.store_list(times.len(), bytemuck::cast_slice(&times)));
        let mut words = vec![8, times.0, 8, samples.len() as u64];
        words.extend(samples.iter().map(|(_, rep)| rep.0));
        Rep::at(Type::TimeSamples, self.store(bytemuck::cast_slice(&words)))
    }

    /// The values, the tables and their contents.
    pub(super) fn finish(mut self) -> Tail {
        self.list_children();
        let mut specs = Specs::default();
        for (path, node) in self.nodes.iter().enumerate() {
            specs.add(path, node);
        }
        let tables = [
            ("TOKENS", self.token_table()),
            ("STRINGS", table(self.strings.list.len(), bytemuck::cast_slice(&self.strings.list))),
            ("FIELDS", specs.field_table()),
            ("FIELDSETS", table(specs.sets.len(), &coding::compressed(&coding::integers(&specs.sets)))),
            ("PATHS", self.path_table()),
            ("SPECS", specs.table()),
        ];
        let mut bytes = std::mem::take(&mut self.values);
        let mut contents = (tables.len() as u64).to_le_bytes().to_vec();
        for (name, table) in tables {
            bytes.resize(bytes.len().next_multiple_of(8), 0);
            let mut word = [0; 16];
            word[..name.len()].copy_from_slice(name.as_bytes());
            contents.extend_from_slice(&word);
            contents.extend((self.base + bytes.len() as u64).to_le_bytes());
            contents.extend((table.len() as u64).to_le_bytes());
            bytes.extend(table);
        }
        let offset = self.base + bytes.len() as u64;
        bytes.extend(contents);
        Tail { bytes, contents: offset }
    }

    /// Each object lists its parts and its attributes.
    fn list_children(&mut self) {
        for node in 0..self.nodes.len() {
            for (field, is_property) in [("primChildren", false), ("properties", true)] {
                let children = self.nodes[node].children.iter().map(|&child| &self.nodes[child]);
                let names: Vec<String> = children
                    .filter(|child| child.is_property == is_property)
                    .map(|child| self.tokens.list[child.name as usize].clone())
                    .collect();
                if !names.is_empty() {
                    let entry = (self.token(field), self.rep(Value::Names(names)));
                    self.nodes[node].fields.push(entry);
                }
            }
        }
    }

    fn token_table(&self) -> Vec<u8> {
        let mut words = Vec::new();
        for word in &self.tokens.list {
            words.extend_from_slice(word.as_bytes());
            words.push(0);
        }
        let size = (words.len() as u64).to_le_bytes();
        table(self.tokens.list.len(), &[&size[..], &coding::compressed(&words)].concat())
    }

    /// The tree of paths, depth first: numbers, names, and the way to the next part and the next sibling.
    fn path_table(&self) -> Vec<u8> {
        let (mut numbers, mut names, mut jumps) = (Vec::new(), Vec::new(), Vec::new());
        self.add_path(0, false, (&mut numbers, &mut names, &mut jumps));
        let count = (numbers.len() as u64).to_le_bytes();
        let lists = [numbers, names, jumps].map(|list| coding::compressed(&coding::integers(&list)));
        table(self.nodes.len(), &[&count[..], &lists.concat()].concat())
    }

    fn add_path(
        &self,
        path: usize,
        has_sibling: bool,
        (numbers, names, jumps): (&mut Vec<i32>, &mut Vec<i32>, &mut Vec<i32>),
    ) {
        let node = &self.nodes[path];
        let start = numbers.len();
        numbers.push(path as i32);
        names.push(if node.is_property { -(node.name as i32) } else { node.name as i32 });
        jumps.push(0);
        for (n, &child) in node.children.iter().enumerate() {
            self.add_path(child, n + 1 < node.children.len(), (&mut *numbers, &mut *names, &mut *jumps));
        }
        jumps[start] = match (node.children.is_empty(), has_sibling) {
            (true, false) => -2,
            (false, false) => -1,
            (true, true) => 0,
            (false, true) => (numbers.len() - start) as i32,
        };
    }
}

/// Bits of the changes of a list.
const EXPLICIT: u8 = 0b11;
const PREPENDED: u8 = 1 << 5;

/// A table: its size in entries, and its data.
fn table(count: usize, data: &[u8]) -> Vec<u8> {
    [&(count as u64).to_le_bytes()[..], data].concat()
}

/// Which path has which fields.
#[derive(Debug, Default)]
struct Specs {
    fields: Vec<(u32, Rep)>,
    numbers: HashMap<(u32, Rep), usize>,
    /// The fields of each path, ended by -1.
    sets: Vec<i32>,
    paths: Vec<i32>,
    starts: Vec<i32>,
    kinds: Vec<i32>,
}

impl Specs {
    fn add(&mut self, path: usize, node: &Node) {
        let Some(kind) = node.kind else { return };
        self.paths.push(path as i32);
        self.starts.push(self.sets.len() as i32);
        self.kinds.push(kind as i32);
        for &field in &node.fields {
            let next = self.fields.len();
            let number = *self.numbers.entry(field).or_insert(next);
            if number == next {
                self.fields.push(field);
            }
            self.sets.push(number as i32);
        }
        self.sets.push(-1);
    }

    fn field_table(&self) -> Vec<u8> {
        let names: Vec<i32> = self.fields.iter().map(|(name, _)| *name as i32).collect();
        let values: Vec<u64> = self.fields.iter().map(|(_, rep)| rep.0).collect();
        let names = coding::compressed(&coding::integers(&names));
        table(self.fields.len(), &[names, coding::compressed(bytemuck::cast_slice(&values))].concat())
    }

    fn table(&self) -> Vec<u8> {
        let lists = [&self.paths, &self.starts, &self.kinds];
        table(self.paths.len(), &lists.map(|list| coding::compressed(&coding::integers(list))).concat())
    }
}
