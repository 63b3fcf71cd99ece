use glam::{Vec3, Vec4};
use rayon::prelude::*;

use super::BoundaryMatrixBindings;
use crate::bodies::types::Contact;

const CHUNK: usize = 4096;

pub(super) fn boundary_matrix(buffers: BoundaryMatrixBindings<'_>) {
    let BoundaryMatrixBindings { params, cell_start, contacts, boundary_matrices } = buffers;
    let n = cell_start[cell_start.len() - 2] as usize;
    let scale = 1.0 / params.support_radius;
    let contacts = contacts.as_chunks::<2>().0;
    let matrices = &mut boundary_matrices.as_chunks_mut::<2>().0[..n];
    matrices.par_iter_mut().zip(contacts).with_min_len(CHUNK).for_each(|(matrix, contacts)| {
        *matrix = [Vec4::ZERO; 2];
        for contact in contacts.iter().filter(|contact| contact.body != Contact::NONE) {
            let normal = contact.direction(scale);
            let along = contact.kernel_fraction + contact.slope.length() * contact.effective.max(0.0);
            let others = Vec3::new(normal.x * normal.y, normal.x * normal.z, normal.y * normal.z);
            matrix[0] += (along * normal * normal).extend(contact.kernel_fraction);
            matrix[1] += (along * others).extend(0.0);
        }
    });
}
