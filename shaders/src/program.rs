//! The loops of a compiled pass, from the assembly that the driver prints.

/// The instructions of a program by the depth of their loops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Program {
    /// Instructions outside loops.
    pub straight: u32,
    /// Instructions of loops that contain a loop: over images and rows of cells.
    pub outer: u32,
    /// Instructions of the longest loop within another one: over the particles of a row.
    pub inner: u32,
}

/// Reads the assembly of ACO: one instruction per line, `BBn:` before each basic block.
pub fn program(assembly: &str) -> Program {
    // The blocks in the order of the program, with their instructions and branches.
    let mut blocks: Vec<(u32, u32, Vec<u32>)> = vec![(0, 0, Vec::new())];
    for line in assembly.lines().map(str::trim) {
        if let Some(number) = line.strip_suffix(':').and_then(block) {
            blocks.push((number, 0, Vec::new()));
            continue;
        }
        let code = line.split(';').next().unwrap_or_default();
        let mut words = code.split_whitespace();
        let Some(name) = words.next().filter(|name| is_instruction(name)) else { continue };
        if let Some(current) = blocks.last_mut() {
            current.1 += 1;
            if name.contains("branch") {
                current.2.extend(words.next().and_then(block));
            }
        }
    }
    let place = |number: u32| blocks.iter().position(|block| block.0 == number);
    // A branch backwards closes a loop. Loops of one header are the same loop.
    let mut loops: Vec<(usize, usize)> = Vec::new();
    for (end, (_, _, targets)) in blocks.iter().enumerate() {
        for start in targets.iter().filter_map(|&target| place(target)).filter(|&start| start <= end) {
            match loops.iter_mut().find(|one| one.0 == start) {
                Some(one) => one.1 = one.1.max(end),
                None => loops.push((start, end)),
            }
        }
    }
    let contains = |a: &(usize, usize), b: &(usize, usize)| a != b && a.0 <= b.0 && b.1 <= a.1;
    let length = |range: &(usize, usize)| blocks[range.0..=range.1].iter().map(|block| block.1).sum::<u32>();
    let total: u32 = blocks.iter().map(|block| block.1).sum();
    let is_nested = |one: &&(usize, usize)| loops.iter().any(|other| contains(other, one));
    let is_innermost = |one: &&(usize, usize)| !loops.iter().any(|other| contains(one, other));
    let inner = loops.iter().filter(is_nested).filter(is_innermost).max_by_key(|one| length(one));
    let Some(inner) = inner else { return Program { straight: total, ..Program::default() } };
    let outermost = loops.iter().filter(|one| contains(one, inner)).map(length).max().unwrap_or(0);
    let longest = length(inner);
    Program { straight: total - outermost, outer: outermost - longest, inner: longest }
}

fn block(word: &str) -> Option<u32> {
    word.strip_prefix("BB")?.parse().ok()
}

fn is_instruction(word: &str) -> bool {
    let families = ["s_", "v_", "ds_", "buffer_", "global_", "flat_", "scratch_", "image_"];
    families.iter().any(|family| word.starts_with(family))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instructions_are_counted_by_their_loops() {
        let text = "BB0:\n\ts_mov_b32 s0, 0 ; be\n\tv_add_f32 v0, v0, v1 ; 02\nBB1:\n\ts_nop 0 ; bf\nBB2:\n\tv_mul_f32 v0, v0, v1 ; 10\n\
                    \tv_mul_f32 v0, v0, v1 ; 10\n\ts_cbranch_scc1 BB2 ; bf\nBB3:\n\ts_cbranch_scc0 BB1 ; bf\nBB4:\n\ts_endpgm ; bf\n";
        assert_eq!(program(text), Program { straight: 3, outer: 2, inner: 3 });
        // Control: without the outer branch the loop is not one over neighbours.
        let flat = text.replace("s_cbranch_scc0 BB1", "s_nop 0");
        assert_eq!(program(&flat), Program { straight: 8, outer: 0, inner: 0 });
    }
}
