//! Rules that the specification states without an identifier.

macro_rules! own_ids {
    ($next:ident $($rest:ident)*; $($table:tt)*) => {
        $next! { $($rest)*; $($table)*
            HostBuild01 = "OMM-host_build-01";

            CopySize01 = "OMM-copy_acceleration_structure-01";
            CopyOverlap02 = "OMM-copy_acceleration_structure-02";
            CopyType03 = "OMM-copy_acceleration_structure-03";

            PartlyNan01 = "OMM-triangles_data-01";

            // From here on: those of last resort.
            Buffer01 = "OMM-buffer-01";
            CommandBuffer01 = "OMM-command_buffer-01";
            Contents01 = "OMM-contents-01";
            DeferredOperation01 = "OMM-deferred_operation-01";
            Index01 = "OMM-index-01";
            Instance01 = "OMM-instance-01";
            Memory01 = "OMM-memory-01";
            Object01 = "OMM-object-01";
            Overlap01 = "OMM-overlap-01";
            QueryPool01 = "OMM-query_pool-01";
            Serialized01 = "OMM-serialized-01";
            Size01 = "OMM-size-01";
            Update01 = "OMM-update-01";
            Value01 = "OMM-value-01";
        }
    };
}
