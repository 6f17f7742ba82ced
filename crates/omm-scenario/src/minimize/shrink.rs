//! The search itself: which elements of a list can go.

use crate::tree::Tree;

/// Leaves out of a list what need not be there, as far as `still` says of what is left that it will do.
///
/// Pieces get smaller by half, from the whole list to single elements, and are taken from the back, as what comes later needs what
/// comes before. At the end no element can go by itself. `still` was true of what is returned, unless that is the whole list.
pub(super) fn shrink<T: Clone>(mut list: Vec<T>, still: &mut dyn FnMut(&[T]) -> bool) -> Vec<T> {
    let mut size = list.len();
    while size > 0 {
        let (mut end, before) = (list.len(), list.len());
        while end > 0 {
            let start = end.saturating_sub(size);
            let (head, tail) = (list.iter().take(start), list.iter().skip(end));
            let candidate: Vec<T> = head.chain(tail).cloned().collect();
            if still(&candidate) {
                list = candidate;
            }
            end = start;
        }
        if size > 1 || list.len() == before {
            size /= 2;
        }
    }
    list
}

/// Visits every list in a value with its number: outer lists have smaller numbers than those inside, which are visited first.
pub(super) fn each_list(tree: &mut Tree, visit: &mut dyn FnMut(usize, &mut Vec<Tree>)) {
    visit_lists(tree, &mut 0, visit);
}

fn visit_lists(tree: &mut Tree, next: &mut usize, visit: &mut dyn FnMut(usize, &mut Vec<Tree>)) {
    match tree {
        Tree::List(items) => {
            let number = *next;
            *next += 1;
            items.iter_mut().for_each(|item| visit_lists(item, next, visit));
            visit(number, items);
        }
        Tree::Some(inner) | Tree::Newtype(_, inner) | Tree::Variant(_, _, Some(inner)) => {
            visit_lists(inner, next, visit);
        }
        Tree::Struct(_, fields) => fields.iter_mut().for_each(|(_, field)| visit_lists(field, next, visit)),
        Tree::Bool(_) | Tree::Integer(_) | Tree::Float(_) | Tree::Text(_) | Tree::None | Tree::Variant(_, _, None) => {}
    }
}

/// The length of the list of that number, if there are so many.
pub(super) fn length_of_list(tree: &mut Tree, number: usize) -> Option<usize> {
    let mut length = None;
    each_list(tree, &mut |found, list| {
        if found == number {
            length = Some(list.len());
        }
    });
    length
}

/// Leaves in one list, or in all lists of its length, only the elements at these positions.
pub(super) fn keep_elements(tree: &mut Tree, number: usize, together: Option<usize>, kept: &[usize]) {
    each_list(tree, &mut |found, list| {
        if found == number || together == Some(list.len()) {
            let mut position = 0..;
            list.retain(|_| position.next().is_some_and(|position| kept.binary_search(&position).is_ok()));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_needed_stays() {
        let needed = [3, 4, 17];
        let mut runs = 0;
        let left = shrink((0..40).collect(), &mut |list: &[i32]| {
            runs += 1;
            needed.iter().all(|number| list.contains(number))
        });
        assert_eq!(left, needed);
        assert!(runs < 80, "{runs}");
        // Pairs that hold each other up go together, as long as they are in one piece.
        let left = shrink(vec![1, 1, 2, 2], &mut |list: &[i32]| list.iter().filter(|&&one| one == 1).count() != 1);
        assert!(left.is_empty(), "{left:?}");
        assert_eq!(shrink(vec![1, 2], &mut |_| false), [1, 2]);
    }

    #[test]
    fn lists_are_numbered_from_outside() {
        let list = |items| Tree::List(items);
        let number = |number| Tree::Integer(number);
        let mut tree = list(vec![list(vec![number(1)]), Tree::Some(Box::new(list(vec![number(2), number(3)])))]);
        assert_eq!([0, 1, 2, 3].map(|number| length_of_list(&mut tree, number)), [Some(2), Some(1), Some(2), None]);
        let mut alone = tree.clone();
        keep_elements(&mut alone, 2, None, &[1]);
        let inner = Tree::Some(Box::new(list(vec![number(3)])));
        assert_eq!(alone, list(vec![list(vec![number(1)]), inner.clone()]));
        keep_elements(&mut tree, 2, Some(2), &[1]);
        assert_eq!(tree, list(vec![inner]));
    }
}
